#pragma once
/// Fineness of the tessellation of curved faces.

#include "scintray/core/vec.hpp"

namespace scintray::mesh {

/// Limits of a tessellation; both hold. The defaults keep the radius of a 2 mm fibre within 0.1 % and cut a
/// full circle in 72 or more.
struct Tessellation {
  double deviation_mm = 0.01;  ///< largest distance of a triangle from the face that it represents
  double angle_rad = 5.0 * core::kDegree;  ///< largest angle between neighbouring triangles or edges
  /// Share of a face's radius that the deviation may reach where that is more than `deviation_mm`; not used
  /// for CAD faces.
  double deviation_per_radius = 0.0;
  /// Largest deviation (mm) from a face of this radius (mm).
  double deviation_at(double radius_mm) const;
  bool operator==(const Tessellation&) const = default;
};

/// Number of segments of a circular arc that satisfies both limits: an arc of angle a over a chord deviates
/// by r (1 - cos(a / 2)) from it. At least `least`.
int arc_segments(double radius_mm, double arc_rad, const Tessellation& tessellation, int least = 1);

}  // namespace scintray::mesh
