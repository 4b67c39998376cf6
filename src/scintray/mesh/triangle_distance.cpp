#include "scintray/mesh/triangle_distance.hpp"

#include <algorithm>

namespace scintray::mesh {

double share_along_segment(const core::Vec3& p, const core::Vec3& a, const core::Vec3& b) {
  const core::Vec3 along = b - a;
  const double length2 = along.squaredNorm();
  return length2 > 0.0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
}

double distance_to_segment(const core::Vec3& p, const core::Vec3& a, const core::Vec3& b) {
  return (p - a - share_along_segment(p, a, b) * (b - a)).norm();
}

core::Vec3 closest_point_in_triangle(const core::Vec3& p, const core::Vec3& a, const core::Vec3& b,
                                     const core::Vec3& c) {
  const core::Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return a;
  const core::Vec3 bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + d1 / (d1 - d3) * ab;
  const core::Vec3 cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  }
  const double denominator = va + vb + vc;
  return a + (vb / denominator) * ab + (vc / denominator) * ac;
}

double distance_to_triangle(const core::Vec3& p, const core::Vec3& a, const core::Vec3& b,
                            const core::Vec3& c) {
  return (closest_point_in_triangle(p, a, b, c) - p).norm();
}

}  // namespace scintray::mesh
