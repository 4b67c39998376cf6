#pragma once
/// Loads, places and tags the parts of a scene.

#include <vector>

#include "scintray/contact/placed_mesh.hpp"
#include "scintray/mesh/import/mesh_format.hpp"
#include "scintray/scene_file/spec.hpp"

namespace scintray::scene {

/// Places every part of the scene, with the parts that fill gaps after the part they belong to.
/// Adds to `problems`: unreadable or unsound meshes, faces that two rules match, rules that match
/// nothing, faces without a surface, touching a part that does not stand earlier. A part with
/// problems may be missing from the result. Of a builder's parts only the first with problems tells them.
/// @param formats  that mesh files may have
[[nodiscard]] std::vector<contact::PlacedMesh> place_parts(
    const scene_file::SceneSpec& spec, core::Problems& problems,
    const mesh::MeshFormats& formats = mesh::MeshFormats::built_in());

}  // namespace scintray::scene
