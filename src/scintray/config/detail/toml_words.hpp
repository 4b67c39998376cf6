#pragma once
/// Phrases of the messages about values in a TOML document.

#include <string>
#include <vector>

#include "scintray/config/toml_reader.hpp"
#include "scintray/core/text.hpp"
#include "scintray/core/units.hpp"

namespace scintray::config {

/// Kind of a value, with a scalar's content: "the string "x"", "an array".
std::string kind_name(const TomlNode& value);
/// The unit used in examples of a dimension; empty for a dimension without one.
std::string usual_unit(core::Dimension dimension);
/// The expected form of a quantity: "a length with its unit, as "2 mm"".
std::string expected_quantity(core::Dimension dimension);
/// The hint for a bare number where a quantity is expected: the number with the usual unit, and with the one
/// that it may have come from.
std::string with_unit_hint(const std::string& number, core::Dimension dimension);
/// "did you mean "x"? "; empty when no word is near.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& known);

}  // namespace scintray::config
