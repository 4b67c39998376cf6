#include "scintray/mesh/tessellation.hpp"

#include <algorithm>
#include <cmath>

namespace scintray::mesh {

double Tessellation::deviation_at(double radius_mm) const {
  return std::max(deviation_mm, deviation_per_radius * radius_mm);
}

int arc_segments(double radius_mm, double arc_rad, const Tessellation& tessellation, int least) {
  constexpr double kMost = 1e6;  // beyond it the caller's own limit of triangles applies anyway
  double step = tessellation.angle_rad;
  const double deviation_mm = tessellation.deviation_at(radius_mm);
  if (radius_mm > 0.0 && deviation_mm < radius_mm)
    step = std::min(step, 2.0 * std::acos(1.0 - deviation_mm / radius_mm));
  // The last digits of an arc such as 2 pi must not add a segment.
  const double segments = std::ceil(arc_rad / step - 1e-9);
  return std::max(least, static_cast<int>(std::min(segments, kMost)));
}

}  // namespace scintray::mesh
