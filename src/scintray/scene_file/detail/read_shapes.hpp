#pragma once
/// Reading the shapes of scene files.

#include <optional>
#include <string>

#include "scintray/config/toml_reader.hpp"
#include "scintray/scene_file/shape_spec.hpp"

namespace scintray::scene_file {

/// True when the key's value is written as an array.
bool is_array(const config::TomlTable& table, const std::string& key);

/// The one shape that a [[part]] or an element gives, with its chamfer. A unit box when it is wrong.
ShapeSpec read_shape(const config::TomlTable& part);

/// { low = [...], high = [...] } under `key`; nothing when absent or wrong.
std::optional<BoxSpec> read_low_high(const config::TomlTable& table, const std::string& key);

}  // namespace scintray::scene_file
