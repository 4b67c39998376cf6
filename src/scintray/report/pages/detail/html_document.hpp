#pragma once
/// The frame of all HTML that is written: self-contained, nothing loaded from elsewhere.

#include <string>
#include <string_view>
#include <vector>

namespace scintray::report {

/// A complete document, in which only its own scripts may run.
struct HtmlDocument {
  std::string title;                        ///< plain text
  std::string style;                        ///< CSS
  std::string body;                         ///< HTML
  std::vector<std::string_view> scripts{};  ///< after the body
  bool page_script = false;                 ///< whether the script of pages follows them
};

/// The document's text. Its Content-Security-Policy allows only its own styles, pictures and scripts.
std::string html_document(const HtmlDocument& document);

/// CSS of the script of pages (values under the pointer, zoom, saved plots, sorted and searched tables);
/// empty in a build without the D3 modules that the script uses.
std::string_view page_script_style();

}  // namespace scintray::report
