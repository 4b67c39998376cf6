#pragma once
/// JSON as text for people and programs.

#include <nlohmann/json.hpp>
#include <string>

namespace scintray::report {

/// A member or an element a line, and lists of plain values (numbers, text) on one line each. Text that is
/// not UTF-8 has U+FFFD in place of what is not.
std::string json_text(const nlohmann::ordered_json& json);

}  // namespace scintray::report
