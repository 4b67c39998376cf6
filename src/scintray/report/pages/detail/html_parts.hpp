#pragma once
/// Elements of HTML for sections.

#include <cstddef>
#include <string>
#include <vector>

namespace scintray::report {

/// <tag class="kind">escaped text</tag>.
std::string cell(const std::string& text, const char* tag = "td", const char* kind = "");

/// A right-aligned cell.
std::string number_cell(const std::string& text);

/// Opening tag of an area that scrolls sideways, which the keyboard reaches. @param name  for screen readers
std::string scroll_area(const std::string& name);

/// A table that scrolls when it is wide, folded when it is long unless `fold` is false. `rows` is HTML.
/// Columns from `first_number` on are right-aligned, as numbers are.
std::string table(const std::vector<std::string>& head, const std::string& rows, std::size_t first_number = 1,
                  bool fold = true);

/// A <section> with a heading.
std::string section(const std::string& title, const std::string& body);

}  // namespace scintray::report
