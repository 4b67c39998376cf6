#include "scintray/mesh/shapes/profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "scintray/mesh/diagnosis.hpp"
#include "scintray/mesh/shapes/shape_error.hpp"
#include "scintray/mesh/shapes/solids.hpp"

namespace scintray::mesh {

namespace {

/// A quadric about the z axis, or the one of the profile's last wall, where this is the same over a range of
/// z.
SupportSurface same_as_last(const Profile& profile, const std::string& group,
                            const std::array<double, 2>& range, const SupportSurface& own) {
  if (profile.sides.empty() || profile.sides.back().group != group || !profile.sides.back().surface)
    return own;
  const SupportSurface& last = *profile.sides.back().surface;
  const auto radius2 = [](const SupportSurface& s, double at) {
    const double z = at - s.origin.z();
    return s.radius2 + (2.0 * s.slope - s.axial * z) * z;
  };
  constexpr double kRounding = 1e-13;
  double largest = 0.0, off = 0.0;
  for (const double z : {range[0], 0.5 * (range[0] + range[1]), range[1]}) {
    largest = std::max(largest, radius2(own, z));
    off = std::max(off, std::abs(radius2(own, z) - radius2(last, z)));
  }
  return off <= kRounding * largest ? last : own;
}

}  // namespace

std::optional<SupportSurface> straight_wall(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                                            double near) {
  if (std::abs(to.x() - from.x()) <= near)
    return SupportSurface::cylinder(core::Vec3::Zero(), core::Vec3::UnitZ(), from.x());
  const double rise = to.y() - from.y();
  if (std::abs(rise) <= near) return std::nullopt;
  // From the wider end, whose radius is above zero.
  const Eigen::Vector2d wide = from.x() > to.x() ? from : to, narrow = from.x() > to.x() ? to : from;
  const double up = narrow.y() > wide.y() ? 1.0 : -1.0;
  return SupportSurface::cone({0.0, 0.0, wide.y()}, {0.0, 0.0, up}, wide.x(), narrow.x(), std::abs(rise));
}

void add_smooth(Profile& profile, const SmoothPoint& from, const SmoothPoint& to, const std::string& group) {
  // radius^2 = w + s (z - z0) + a (z - z0)^2 up to the middle, and from the end back, with b, to there.
  const double half = 0.5 * (to.z - from.z);
  const double sum = (to.rate - from.rate) / (2.0 * half);
  const double difference = ((to.radius2 - from.radius2) / half - (from.rate + to.rate)) / half;
  const double a = 0.5 * (sum + difference), b = 0.5 * (sum - difference);
  const double middle2 = from.radius2 + (from.rate + a * half) * half;
  if (!(middle2 >= 0.0))
    reject_shape("a smooth profile that crosses the axis between two of its corners", "give more corners");
  const core::Vec3 z = core::Vec3::UnitZ();
  const double middle = from.z + half;
  profile.add({std::sqrt(from.radius2), from.z}, group,
              same_as_last(profile, group, {from.z, middle},
                           SupportSurface::quadric(from.z * z, z, -a, 0.5 * from.rate, from.radius2)));
  profile.add({std::sqrt(middle2), middle}, group,
              same_as_last(profile, group, {middle, to.z},
                           SupportSurface::quadric(to.z * z, z, -b, 0.5 * to.rate, to.radius2)));
}

TriMesh revolve(const Profile& profile, int segments) {
  TriMesh mesh = revolved(profile.corners, {.segments = segments});
  if (mesh.triangles.empty() || !(mesh.volume() > 0.0) || !mesh_problems(diagnose(mesh), "it").empty())
    reject_shape("a profile that crosses itself, or holds no volume",
                 "give its corners in order along its edge, the first and the last on the axis (r = 0)");
  const std::size_t count = profile.corners.size();
  std::vector<std::size_t> corner_of;
  for (const core::Vec3& vertex : mesh.vertices) {
    const Eigen::Vector2d at(std::hypot(vertex.x(), vertex.y()), vertex.z());
    const auto nearest = std::min_element(profile.corners.begin(), profile.corners.end(),
                                          [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
                                            return (a - at).squaredNorm() < (b - at).squaredNorm();
                                          });
    corner_of.push_back(static_cast<std::size_t>(nearest - profile.corners.begin()));
  }
  // The corners of a triangle are two neighbours of the profile; sides on the axis have none.
  std::vector<std::size_t> side_of;
  std::vector<bool> used(count, false);
  for (const auto& triangle : mesh.triangles) {
    std::size_t side = 0;
    for (const std::uint32_t vertex : triangle) {
      const std::size_t one = corner_of[vertex];
      for (const std::uint32_t other : triangle)
        if (corner_of[other] == (one + 1) % count) side = one;
    }
    side_of.push_back(side);
    used[side] = true;
  }
  mesh.groups.clear();
  mesh.group.clear();
  std::vector<std::uint32_t> group_of(count, 0), support_of(count, kNoSupport);
  for (std::size_t side = 0; side < count; ++side) {
    if (!used[side]) continue;
    group_of[side] = mesh.group_index(profile.sides[side].group);
    if (profile.sides[side].surface) support_of[side] = mesh.support_index(*profile.sides[side].surface);
  }
  for (const std::size_t side : side_of) {
    mesh.group.push_back(group_of[side]);
    mesh.support.push_back(support_of[side]);
  }
  if (mesh.supports.empty()) mesh.support.clear();
  return mesh;
}

}  // namespace scintray::mesh
