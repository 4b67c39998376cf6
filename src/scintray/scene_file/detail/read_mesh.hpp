#pragma once
/// The mesh file of a part.

#include "scintray/scene_file/spec.hpp"

namespace scintray::scene_file {

/// mesh = "FILE" of a [[part]], with the keys that belong to it: unit, scale, body, tessellation.
MeshFileSpec read_mesh(const config::TomlTable& part);

}  // namespace scintray::scene_file
