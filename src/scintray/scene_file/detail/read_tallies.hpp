#pragma once
/// Reading [[tally]].

#include "scintray/scene_file/spec.hpp"

namespace scintray::scene_file {

/// Fills scene.exit_angles and scene.tallies, names checked against scene.parts.
void read_tallies(const config::TomlTable& table, SceneSpec& scene);

}  // namespace scintray::scene_file
