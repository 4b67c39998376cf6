#pragma once
/// Reports of the benchmark in JSON; docs/performance.md describes the keys.

#include <filesystem>
#include <string>

#include "figures.hpp"

namespace scintray::bench {

/// Text of a report, indented, with a line's end.
std::string json_of(const Report& report);

/// The report in a text.
/// @param name  of the file, for messages
/// @throws InputError when it is no report, or one of a later format
Report report_of_json(const std::string& text, const std::string& name);

/// The report in a file. @throws InputError as above, and when the file cannot be read
Report load_report(const std::filesystem::path& path);

}  // namespace scintray::bench
