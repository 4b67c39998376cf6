#pragma once
/// Surfaces over holes. CGAL stays in the one file behind this header.

#include <array>
#include <cstdint>
#include <vector>

#include "scintray/core/vec.hpp"

namespace scintray::mesh {

/// Triangles (indices into `loop`) over a closed loop of three or more points, of the smallest worst
/// dihedral angle and then area (P. Liepa 2003, "Filling holes in meshes"). They run against the loop:
/// a loop in the sense of the open edges' own triangles gives triangles that agree with those. Empty
/// when CGAL finds none.
std::vector<std::array<std::uint32_t, 3>> triangulate_hole(const std::vector<core::Vec3>& loop);

}  // namespace scintray::mesh
