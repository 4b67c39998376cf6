#pragma once
/// Loads, places and tags the parts of a scene.

#include <vector>

#include "scintray/scene/placed_mesh.hpp"
#include "scintray/scene/spec.hpp"

namespace scintray {

/// Places every part of the scene, with the parts that fill gaps after the part they belong to.
/// Adds to `problems`: unreadable or unsound meshes, faces that two rules match, rules that match
/// nothing, faces without a surface, touching a part that does not stand earlier. A part with
/// problems may be missing from the result. Of a builder's parts only the first with problems tells them.
std::vector<PlacedMesh> place_parts(const SceneSpec& spec, Problems& problems);

}  // namespace scintray
