#include "scintray/scene/detail/arrangement.hpp"

#include <algorithm>
#include <cmath>

namespace scintray::scene {

Arrangement arrangement_of(const std::vector<core::Vec3>& points, double tolerance_mm) {
  const core::Vec3& first = points.front();
  const auto far_from = [&](auto distance) {
    return *std::max_element(points.begin(), points.end(), [&](const core::Vec3& a, const core::Vec3& b) {
      return distance(a) < distance(b);
    });
  };
  const core::Vec3 second = far_from([&](const core::Vec3& p) { return (p - first).norm(); });
  const core::Vec3 along = (second - first).normalized();
  const auto off_line = [&](const core::Vec3& p) { return along.cross(p - first).norm(); };
  const core::Vec3 third = far_from(off_line);
  const double near = std::min(tolerance_mm, 1e-3 * (second - first).norm());
  if (off_line(third) <= near) return {Arrangement::Kind::line, along, first};
  const core::Vec3 normal = along.cross(third - first).normalized();
  const auto off_plane = [&](const core::Vec3& p) { return std::abs(normal.dot(p - first)); };
  const bool flat =
      std::all_of(points.begin(), points.end(), [&](const core::Vec3& p) { return off_plane(p) <= near; });
  return {flat ? Arrangement::Kind::plane : Arrangement::Kind::space, normal, first};
}

}  // namespace scintray::scene
