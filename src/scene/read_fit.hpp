#pragma once

#include <optional>

#include "scintray/scene/fit_spec.hpp"
#include "scintray/scene/toml_reader.hpp"

namespace scintray {

/// [fit] of a scene, or nothing. What is wrong is added to the collector of the table.
std::optional<FitSpec> read_fit(const TomlTable& scene);

}  // namespace scintray
