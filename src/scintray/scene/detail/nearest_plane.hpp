#pragma once
/// The bounding plane through which a ray leaves a convex region.

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "scintray/scene/boundary.hpp"

namespace scintray::scene {

/// A plane of Boundary::planes, and the distance (mm) to it along a ray.
struct PlaneAhead {
  double distance_mm = std::numeric_limits<double>::infinity();
  std::size_t plane = 0;
};

/// Scalar product, in the order of additions of the lane kernel of transport.
inline double product(const core::PlainVec3& a, const core::Vec3& b) {
  return a.x() * b.x() + a.y() * b.y() + a.z() * b.z();
}

/// `value`, negated where `sign` is negative.
inline double negated_as(double sign, double value) {
  constexpr std::uint64_t kSign = std::uint64_t{1} << 63;
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(value) ^
                               (std::bit_cast<std::uint64_t>(sign) & kSign));
}

/// The nearest plane that a ray from inside a convex region crosses outwards; of negative distances, by
/// rounding, 0. Without branches, as which plane it is cannot be predicted at rough faces: branches
/// cost 2.4 wrong predictions a segment there.
inline PlaneAhead nearest_plane(const Boundary& boundary, const core::Vec3& origin,
                                const core::Vec3& direction) {
  const BoundingPlane* const planes = boundary.planes.data();
  PlaneAhead nearest;
  const auto take = [&nearest](double distance_mm, std::size_t plane) {
    nearest.plane = distance_mm < nearest.distance_mm ? plane : nearest.plane;
    nearest.distance_mm = distance_mm < nearest.distance_mm ? distance_mm : nearest.distance_mm;
  };
  const auto from_inside = [](double height) { return height > 0.0 ? height : 0.0; };
  for (std::size_t i = 0; i < boundary.opposite_planes; i += 2) {
    // Of two opposite planes the ray leaves through the one whose normal is along it; through none of those
    // that it is parallel to, whose distance is infinite or, of a ray on one of them, no number.
    const double along = product(planes[i].normal, direction), height = product(planes[i].normal, origin);
    const std::size_t one = i + (std::bit_cast<std::uint64_t>(along) >> 63);
    take(from_inside(planes[one].offset - negated_as(along, height)) * (1.0 / std::abs(along)), one);
  }
  for (std::size_t i = boundary.opposite_planes; i < boundary.planes.size(); ++i) {
    const double along = product(planes[i].normal, direction);
    const double distance_mm =
        from_inside(planes[i].offset - product(planes[i].normal, origin)) * (1.0 / along);
    take(along > 0.0 ? distance_mm : std::numeric_limits<double>::infinity(), i);
  }
  return nearest;
}

}  // namespace scintray::scene
