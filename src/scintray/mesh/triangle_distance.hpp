#pragma once
/// Distances from a point to a segment and to a triangle.

#include "scintray/core/vec.hpp"

namespace scintray::mesh {

/// Parameter along the segment from `a` to `b` of the point nearest `p`: 0 at `a`, 1 at `b`; 0 when the two
/// are one point.
[[nodiscard]] double share_along_segment(const core::Vec3& p, const core::Vec3& a, const core::Vec3& b);

/// Distance from a point to the segment from `a` to `b`, in the unit of the coordinates.
[[nodiscard]] double distance_to_segment(const core::Vec3& p, const core::Vec3& a, const core::Vec3& b);

/// The point of the triangle nearest `p` (C. Ericson 2005, "Real-Time Collision Detection", section 5.1.5).
[[nodiscard]] core::Vec3 closest_point_in_triangle(const core::Vec3& p, const core::Vec3& a,
                                                   const core::Vec3& b, const core::Vec3& c);

/// Distance from a point to a triangle, in the unit of the coordinates; 0 on it.
[[nodiscard]] double distance_to_triangle(const core::Vec3& p, const core::Vec3& a, const core::Vec3& b,
                                          const core::Vec3& c);

}  // namespace scintray::mesh
