#pragma once
/// Closed bodies swept from outlines. Lengths in mm.

#include <Eigen/Core>
#include <array>
#include <functional>
#include <vector>

#include "scintray/mesh/tessellation.hpp"
#include "scintray/mesh/trimesh.hpp"

namespace scintray::mesh {

/// Limit of the triangles of a swept body; finer tessellations are errors.
inline constexpr std::size_t kMostSweptTriangles = 4'000'000;

/// A rotation about the z axis: from start_rad counter-clockwise through extent_rad, in flat steps.
struct Turn {
  double start_rad = 0.0;
  double extent_rad = core::kTwoPi;  ///< above 0; a full circle from 2 pi on
  int segments = 64;                 ///< 3 or more for a full circle, 1 or more otherwise
};

/// The body that a closed outline of (r, z), r >= 0, sweeps about the z axis; corners of the body lie on the
/// circles of the outline's corners. Parts of the outline on the axis make no face.
/// @throws InputError for an outline of fewer than 3 corners or with a negative radius, for too few segments,
///         and for more triangles than kMostSweptTriangles.
TriMesh revolved(const std::vector<Eigen::Vector2d>& outline, const Turn& turn);

/// The body between flat outlines, one above the other, that have the same number of corners: walls between
/// each and the next, two triangles for each side, and the first and the last as its ends.
/// @throws InputError for fewer than 2 outlines, or outlines of fewer than 3 or of different numbers of
/// corners.
TriMesh lofted(const std::vector<std::vector<core::Vec3>>& outlines);

/// The image of the unit cube: its faces are cut in steps along each axis, two triangles for each piece, and
/// their corners mapped. An axis is closed when the map has the same point at both its ends: a ring, which
/// has no faces there.
/// @param steps   along each axis, 1 or more, and 3 or more of a closed one
/// @param closed  not all of the three
/// @throws InputError for fewer steps, and for more triangles than kMostSweptTriangles
TriMesh mapped_cube(const std::array<int, 3>& steps, const std::array<bool, 3>& closed,
                    const std::function<core::Vec3(const core::Vec3&)>& map);

/// Corners of (r, z) along an ellipse about (r0, z0) with half axes a (along r) and b (along z), from one
/// angle to the other (0 on the +r side, counter-clockwise towards +z), both ends included, as finely as the
/// tessellation requires for a circle of the larger half axis.
std::vector<Eigen::Vector2d> arc(const Eigen::Vector2d& centre, double a, double b, double from_rad,
                                 double to_rad, const Tessellation& tessellation);

}  // namespace scintray::mesh
