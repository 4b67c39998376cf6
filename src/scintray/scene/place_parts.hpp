#pragma once
/// Loading, placement and face tags of the parts of a scene.

#include <vector>

#include "scintray/contact/placed_mesh.hpp"
#include "scintray/mesh/import/mesh_format.hpp"
#include "scintray/scene_file/spec.hpp"

namespace scintray::scene {

/// Placed meshes of all parts of the scene; a part that fills a gap follows the part to which it belongs.
/// Adds to `problems`: unreadable or unsound meshes, faces that two rules match, rules that match nothing,
/// faces without a surface, placement against a part that is not defined earlier. A part with problems may be
/// missing from the result. Of a builder's parts only the problems of the first with any are reported.
/// @param formats  formats of mesh files
[[nodiscard]] std::vector<contact::PlacedMesh> place_parts(
    const scene_file::SceneSpec& spec, core::Problems& problems,
    const mesh::MeshFormats& formats = mesh::MeshFormats::built_in());

}  // namespace scintray::scene
