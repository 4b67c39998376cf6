#include "ray_set.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/core/sampling.hpp"

namespace scintray::bench {

namespace {

/// A point of a triangle, uniform over its area.
core::Vec3 point_of(const scene::BoundaryTriangle& triangle, core::Rng& rng) {
  const double root = std::sqrt(rng.uniform()), share = rng.uniform();
  return (1.0 - root) * triangle[0] + root * (1.0 - share) * triangle[1] + root * share * triangle[2];
}

/// Area (mm2) of all triangles up to each.
std::vector<double> areas_up_to(const scene::Accelerator& region) {
  std::vector<double> areas;
  double sum = 0.0;
  for (std::uint32_t i = 0; i < region.size(); ++i) {
    const scene::BoundaryTriangle t = region.triangle(i);
    areas.push_back(sum += 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm());
  }
  return areas;
}

}  // namespace

void RaySet::add(const core::Vec3& origin, const core::Vec3& direction) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    doubles[i].push_back(origin[axis]);
    doubles[i + 3].push_back(direction[axis]);
    floats[i].push_back(static_cast<float>(origin[axis]));
    floats[i + 3].push_back(static_cast<float>(direction[axis]));
  }
}

RaySet isotropic_rays(const scene::Accelerator& region, std::size_t count) {
  const std::vector<double> areas = areas_up_to(region);
  RaySet rays;
  for (std::size_t i = 0; i < count; ++i) {
    core::Rng rng(1, core::StreamKind::other, i);
    const auto above = std::upper_bound(areas.begin(), areas.end(), rng.uniform() * areas.back());
    const auto triangle =
        static_cast<std::uint32_t>(std::min<std::size_t>(above - areas.begin(), areas.size() - 1));
    const core::Vec3 start = point_of(region.triangle(triangle), rng);
    const core::Vec3 inwards = -region.normal(triangle).vec();
    const core::Vec3 direction = core::sample_lambertian(inwards, rng);
    const double length_mm = i % 2 == 0 ? 0.0 : region.find_exit(start, direction).distance_mm;
    rays.add(start + rng.uniform() * length_mm * direction, direction);
  }
  return rays;
}

}  // namespace scintray::bench
