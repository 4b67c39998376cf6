#pragma once
/// Words of the messages about values in a TOML document.

#include <string>
#include <vector>

#include "scintray/config/toml_reader.hpp"
#include "scintray/core/text.hpp"
#include "scintray/core/units.hpp"

namespace scintray::config {

/// What a value is: "the string "x"", "an array".
std::string kind_name(const TomlNode& value);
/// The unit that examples of a dimension have; empty without one.
std::string usual_unit(core::Dimension dimension);
/// "a length with its unit, as "2 mm""
std::string expected_quantity(core::Dimension dimension);
/// "did you mean "x"? ", or nothing when no word is near.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& known);

}  // namespace scintray::config
