#include <cmath>

#include "scintray/transport/detail/step_parts.hpp"

namespace scintray::transport {

std::optional<Eigen::AlignedBox3d> ambient_bounds(const scene::Scene& scene) {
  const scene::Region& ambient = scene.regions[scene::kAmbientRegion];
  const scene::Boundary& boundary = scene.accelerator(ambient).boundary();
  if (!boundary.exact.empty()) return std::nullopt;
  Eigen::AlignedBox3d bounds;
  for (const core::PlainVec3& vertex : boundary.vertices)
    bounds.extend(core::Vec3(ambient.direction_to_world(vertex) + ambient.centre.vec()));
  return bounds;
}

bool leaves_the_scene(const scene::Scene& scene, const std::optional<Eigen::AlignedBox3d>& bounds,
                      const source::Photon& photon, const Step& taken) {
  constexpr double kRounding = 1e-12;  // of planes and corners, relative
  if (!bounds || taken.event != core::StepEvent::transmitted || photon.region != scene::kAmbientRegion ||
      photon.optics.absorption_per_mm + photon.optics.scattering_per_mm > 0.0)
    return false;
  const scene::Region& region = scene.regions[taken.region];
  if (region.curved) return false;
  const core::Vec3 normal = scene.normal(region, taken.triangle);
  const double offset =
      scene.accelerator(region).plane(taken.triangle).zw[1] + normal.dot(region.centre.vec());
  const core::Vec3 middle = bounds->center(), half = 0.5 * bounds->sizes();
  const double reach = normal.dot(middle) + normal.cwiseAbs().dot(half);
  return reach <= offset + kRounding * (std::abs(offset) + half.norm());
}

}  // namespace scintray::transport
