#pragma once

#include <optional>

#include "scintray/config/toml_reader.hpp"
#include "scintray/scene_file/fit_spec.hpp"

namespace scintray::scene_file {

/// [fit] of a scene, or nothing. What is wrong is added to the collector of the table.
std::optional<FitSpec> read_fit(const config::TomlTable& scene);

}  // namespace scintray::scene_file
