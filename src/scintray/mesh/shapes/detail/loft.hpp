#pragma once
/// Bodies put together from convex polygons in planes of constant z.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "scintray/mesh/trimesh.hpp"

namespace scintray::mesh {

/// A convex polygon at a height, counter-clockwise seen from +z. Neighbouring corners may coincide.
struct LoftRing {
  double z = 0.0;
  std::vector<Eigen::Vector2d> corners;
};

/// The closed body between rings of rising z that have the same number of corners, corner i joined to
/// corner i. Sides that shrink to a line or a point are left out.
///
/// @param side_groups  group of the side between corners i and i + 1, by layer (rings less one), then i
/// Both ends are fans without a middle vertex, in the groups "-z" and "+z".
TriMesh make_loft(const std::vector<LoftRing>& rings,
                  const std::vector<std::vector<std::string>>& side_groups);

/// Corners of a regular polygon, first on +x.
std::vector<Eigen::Vector2d> regular_polygon(int corners, double circumradius);

/// Corners of a rectangle: (low x, low y), then counter-clockwise. Its sides are "-y", "+x", "+y", "-x".
std::vector<Eigen::Vector2d> rectangle_corners(const Eigen::Vector2d& low, const Eigen::Vector2d& high);

}  // namespace scintray::mesh
