#pragma once
/// Figures that tests measure, for docs/validation.md, which tools/validation writes from them.

#include <initializer_list>
#include <string>

namespace scintray::test {

/// Adds a row to a table of docs/validation.md, when SCINTRAY_EVIDENCE names a file to write to.
void evidence(const std::string& table, std::initializer_list<std::string> row);

}  // namespace scintray::test
