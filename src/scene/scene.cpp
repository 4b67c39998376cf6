#include "scintray/scene/scene.hpp"

#include <cmath>
#include <limits>

namespace scintray {

namespace {

constexpr double kWavelengthStep_nm = 0.5;

bool constant_optics(const Medium& medium) {
  return medium.index.is_constant() && medium.absorption_per_mm.is_constant() &&
         medium.scattering_per_mm.is_constant() &&
         (!medium.shifter || medium.shifter->absorption_per_mm().is_constant());
}

}  // namespace

SceneMedium::SceneMedium(Medium medium, double low_nm, double high_nm)
    : medium_(std::move(medium)), low_nm_(low_nm) {
  if (constant_optics(medium_) || !(high_nm > low_nm)) {
    table_ = {medium_.at(low_nm)};
    return;
  }
  const auto steps = static_cast<std::size_t>(std::ceil((high_nm - low_nm) / kWavelengthStep_nm));
  per_nm_ = static_cast<double>(steps) / (high_nm - low_nm);
  last_ = static_cast<double>(steps);
  for (std::size_t i = 0; i <= steps; ++i)
    table_.push_back(medium_.at(low_nm + static_cast<double>(i) / per_nm_));
}

SceneMedium SceneMedium::opaque() {
  SceneMedium medium;
  medium.medium_.name = "opaque";
  medium.medium_.index = Curve::constant(1.0);
  medium.table_ = {MediumOptics{}};
  medium.opaque_ = true;
  return medium;
}

bool Scene::region_contains(std::uint32_t region, const Vec3& point) const {
  const Region& candidate = regions[region];
  return candidate.accelerator->contains(candidate.point_to_local(point));
}

bool Scene::region_contains(std::uint32_t region, const Eigen::AlignedBox3d& box) const {
  if (region == kAmbientRegion || !region_contains(region, Vec3(box.center()))) return false;
  constexpr double kRounding = 1e-9;  // of the box's size
  const Vec3 slack = Vec3::Constant(kRounding * box.diagonal().norm());
  const Eigen::AlignedBox3d inner(box.min() + slack, box.max() - slack);
  const Region& candidate = regions[region];
  for (std::uint32_t i = 0; i < candidate.accelerator->size(); ++i) {
    Eigen::AlignedBox3d bounds;
    for (const Vec3& vertex : candidate.accelerator->triangle(i))
      bounds.extend(candidate.centre + candidate.direction_to_world(vertex));
    if (inner.intersects(bounds)) return false;
  }
  return true;
}

std::uint32_t Scene::locate(const Vec3& point) const {
  for (std::uint32_t region = 0; region < regions.size(); ++region)
    if (region != kAmbientRegion && region_contains(region, point)) return region;
  return kAmbientRegion;
}

}  // namespace scintray
