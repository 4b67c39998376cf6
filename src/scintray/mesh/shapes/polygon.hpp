#pragma once
/// Triangulation of polygons.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "scintray/core/vec.hpp"

namespace scintray::mesh {

/// Limit of the corners of a polygon, above which readers throw: ear clipping takes quadratic time.
inline constexpr std::size_t kMostCorners = 20000;

/// Triangles (indices into `corners`) of a simple polygon in space, nearly flat, convex or not, in the
/// polygon's own sense of rotation: ear clipping (G. H. Meisters 1975, "Polygons have ears", Am. Math.
/// Monthly 82) in the plane of its Newell normal. A convex polygon becomes a fan about its first
/// corner. Always corners - 2 triangles; `simple` becomes false when the polygon crosses itself.
std::vector<std::array<std::uint32_t, 3>> triangulate_polygon(const std::vector<core::Vec3>& corners,
                                                              bool& simple);

}  // namespace scintray::mesh
