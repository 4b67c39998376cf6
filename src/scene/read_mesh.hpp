#pragma once
/// The mesh file of a part.

#include "scintray/scene/spec.hpp"

namespace scintray {

/// mesh = "FILE" of a [[part]], with the keys that belong to it: unit, scale, body, tessellation.
MeshFileSpec read_mesh(const TomlTable& part);

}  // namespace scintray
