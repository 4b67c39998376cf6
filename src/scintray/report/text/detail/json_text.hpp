#pragma once
/// JSON as text for people and programs.

#include <nlohmann/json.hpp>
#include <string>

namespace scintray::report {

/// JSON with one member or element per line, and lists of plain values (numbers, text) on one line each.
/// Bytes that are not UTF-8 are replaced by U+FFFD.
std::string json_text(const nlohmann::ordered_json& json);

}  // namespace scintray::report
