#pragma once
/// The self-contained HTML pages: light and dark, nothing loaded from elsewhere.
/// Their script (pages/detail/html_document.hpp) adds interaction; only it and scripts passed to a page may
/// run.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace scintray::report {

/// A page with a list of its sections where there are four or more, whose style covers text, tables (.n:
/// numbers), figures and plots; `style` is added CSS. `title` and `under`, the line below it, are escaped.
/// `body` is HTML.
/// @param scripts  that the body needs, after it and before that of all pages
std::string html_frame(const std::string& title, const std::string& under, const std::string& style,
                       const std::string& body, const std::vector<std::string_view>& scripts = {});

/// The same with ScintRay's version after `under`.
std::string html_page(const std::string& title, const std::string& under, const std::string& style,
                      const std::string& body);

/// Writes a page or a drawing. Throws SystemError on failure.
void write_page(const std::filesystem::path& path, const std::string& content);

}  // namespace scintray::report
