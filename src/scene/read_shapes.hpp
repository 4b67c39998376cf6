#pragma once
/// Reading the shapes of scene files.

#include <optional>
#include <string>

#include "scintray/scene/shape_spec.hpp"
#include "scintray/scene/toml_reader.hpp"

namespace scintray {

/// True when the key's value is written as an array.
bool is_array(const TomlTable& table, const std::string& key);

/// The one shape that a [[part]] or an element gives, with its chamfer. A unit box when it is wrong.
ShapeSpec read_shape(const TomlTable& part);

/// { low = [...], high = [...] } under `key`; nothing when absent or wrong.
std::optional<BoxSpec> read_low_high(const TomlTable& table, const std::string& key);

}  // namespace scintray
