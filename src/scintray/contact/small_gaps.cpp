#include "scintray/contact/neighbours.hpp"

#include <algorithm>

#include "scintray/contact/detail/boolean_difference.hpp"
#include "scintray/contact/detail/clusters.hpp"

namespace scintray::contact {

namespace {

/// A point that most likely lies between the triangles: over the middle of the smaller one, halfway.
core::Vec3 place_between(const Body& a, std::uint32_t ta, const Body& b, std::uint32_t tb, double gap) {
  const bool a_is_smaller = a.area_vector(ta).norm() < b.area_vector(tb).norm();
  const Body& body = a_is_smaller ? a : b;
  const std::uint32_t t = a_is_smaller ? ta : tb;
  return (body.corner(t, 0) + body.corner(t, 1) + body.corner(t, 2)) / 3.0 + 0.5 * gap * body.normal[t];
}

}  // namespace

std::vector<SmallGap> find_small_gaps(const std::vector<PlacedMesh>& parts, double tolerance_mm,
                                      double share) {
  if (parts.empty()) return {};
  const Eigen::Matrix3d axes = difference_axes(parts);
  std::vector<Body> bodies;
  std::vector<double> limit;
  for (const PlacedMesh& part : parts) {
    bodies.emplace_back(geometry_of(part), axes);
    limit.push_back(share * part.diagnosis.bounds.diagonal().norm());
  }
  const double reach = *std::max_element(limit.begin(), limit.end());
  std::vector<SmallGap> gaps;
  for (const BodyPair& pair : near_pairs(bodies, reach)) {
    const Body &a = bodies[pair.a], &b = bodies[pair.b];
    const double widest = std::min(limit[pair.a], limit[pair.b]);
    SmallGap gap{parts[pair.a].name, parts[pair.b].name, HUGE_VAL, core::Vec3::Zero(), 0.0};
    bool touching = false;
    for (const auto& [ta, tb] : pair.parallel) {
      if (a.normal[ta].dot(b.normal[tb]) > 0.0) continue;
      const Plane plane{a.corner(ta, 0), a.normal[ta]};
      const core::Vec3 middle = (b.corner(tb, 0) + b.corner(tb, 1) + b.corner(tb, 2)) / 3.0;
      const double height = plane.height(middle);
      if (height < -tolerance_mm || height > widest) continue;
      const Overlap facing = overlap(a, ta, b, tb, plane);
      if (facing.width() <= tolerance_mm) continue;
      gap.area_mm2 += facing.area;
      if (height >= gap.gap_mm) continue;
      touching |= height <= tolerance_mm;
      gap.gap_mm = height;
      gap.place = place_between(a, ta, b, tb, height);
    }
    const auto filled_by = [&](const Body& other) {
      return &other != &a && &other != &b && other.side_of(gap.place, 0.0) == Side::inside;
    };
    if (touching || !std::isfinite(gap.gap_mm) || std::any_of(bodies.begin(), bodies.end(), filled_by))
      continue;
    gaps.push_back(std::move(gap));
  }
  return gaps;
}

}  // namespace scintray::contact
