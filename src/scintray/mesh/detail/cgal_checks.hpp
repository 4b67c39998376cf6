#pragma once
/// Checks with exact predicates. CGAL is used only in this header's source file.

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "scintray/mesh/trimesh.hpp"

namespace scintray::mesh {

/// Pairs of triangles that intersect other than in the vertices or edge they share by index. Triangles
/// without area, and pairs with the same three vertices, are left out: they are counted elsewhere.
std::vector<std::pair<std::uint32_t, std::uint32_t>> self_intersections(const TriMesh& mesh);

/// The pairs of which one triangle at least is listed. Triangles whose entry in `alive` is 0 are left out.
std::vector<std::pair<std::uint32_t, std::uint32_t>> crossings_with(const TriMesh& mesh,
                                                                    const std::vector<std::uint32_t>& listed,
                                                                    const std::vector<char>& alive);

/// Mask of triangles to reverse so that normals point out of the solid, nested shells alternating.
/// The mesh must be closed, consistently oriented and free of self-intersections.
std::vector<char> reversed_to_bound_a_volume(const TriMesh& mesh);

}  // namespace scintray::mesh
