#pragma once
/// The shape of a part: mesh, box or cylinder.

#include "scintray/scene/spec.hpp"

namespace scintray {

/// Exactly one of mesh, box, cylinder of a [[part]], with the keys that belong to it.
ShapeSpec read_shape(const TomlTable& part);

}  // namespace scintray
