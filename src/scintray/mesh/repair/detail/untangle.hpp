#pragma once
/// Taking self-intersections out of a mesh. CGAL stays in the one file behind this header.

#include <optional>

#include "scintray/mesh/trimesh.hpp"

namespace scintray::mesh {

/// The mesh with the triangles that cross each other, and some around them, replaced: smoothed, or cut
/// out and the hole filled (CGAL's remove_self_intersections, which works where defects are local).
/// New triangles take the group of the first triangle. Nothing when the mesh is no closed, consistently
/// oriented surface or CGAL does not succeed.
std::optional<TriMesh> untangled(const TriMesh& mesh);

}  // namespace scintray::mesh
