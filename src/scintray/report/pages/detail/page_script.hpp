#pragma once
/// The script of pages: values under the pointer, zoom, saved plots, sorted and searched tables.

#include <string>
#include <string_view>

namespace scintray::report {

/// The script, with the D3 modules that it uses; empty in a build without them.
std::string_view page_script();

/// Its CSS; empty like it.
std::string_view page_script_style();

/// A Content-Security-Policy that allows nothing but what is in the page: its styles, its pictures, and the
/// scripts whose SHA-256 (64 hexadecimal digits each, apart by spaces) is in `more` or is that of
/// page_script().
std::string content_policy(std::string_view more = "");

}  // namespace scintray::report
