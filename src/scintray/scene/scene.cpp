#include "scintray/scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scintray::scene {

namespace {

constexpr double kWavelengthStep_nm = 0.5;

bool constant_axes(const optics::Birefringence& medium) {
  return std::all_of(medium.axes.begin(), medium.axes.end(), [](const optics::PrincipalAxis& axis) {
    return axis.index.is_constant() && axis.absorption_per_mm.is_constant() &&
           (!axis.group_index || axis.group_index->is_constant());
  });
}

bool constant_optics(const optics::Medium& medium) {
  return medium.index.is_constant() && medium.absorption_per_mm.is_constant() &&
         medium.scattering_per_mm.is_constant() &&
         (!medium.group_index || medium.group_index->is_constant()) &&
         (!medium.particles || medium.particles->per_mm.is_constant()) &&
         (!medium.shifter || medium.shifter->absorption_per_mm().is_constant()) &&
         (!medium.birefringence || constant_axes(*medium.birefringence));
}

}  // namespace

void SceneOptics::add(const SceneMedium& scene_medium, double low_nm, double high_nm) {
  const optics::Medium& medium = scene_medium.medium();
  MediumRecord record;
  record.first = static_cast<std::uint32_t>(table.size());
  record.scattering = medium.scattering;
  record.opaque = scene_medium.is_opaque();
  record.shifts = medium.shifter != nullptr;
  record.particles = medium.particles.has_value();
  record.first_shift = static_cast<std::uint32_t>(shifting_per_mm.size());
  record.birefringent = medium.birefringence != nullptr;
  record.first_birefringent = static_cast<std::uint32_t>(birefringent.size());
  const bool scatters = medium.scattering_per_mm.max_y() > 0.0;
  const auto tabulate = [&](double wavelength_nm) {
    if (record.birefringent) {
      optics::BirefringentOptics& optics = birefringent.emplace_back(*medium.birefringence, wavelength_nm);
      if (scatters && record.scattering == optics::ScatteringKind::rayleigh) optics.find_dipole_emission();
    }
    table.push_back(medium.at(wavelength_nm));
    if (record.shifts) shifting_per_mm.push_back(medium.shifter->absorption_per_mm()(wavelength_nm));
  };
  if (record.opaque) {
    table.push_back(optics::MediumOptics{});
  } else if (constant_optics(medium) || !(high_nm > low_nm)) {
    tabulate(low_nm);
  } else {
    const auto steps = static_cast<std::uint32_t>(std::ceil((high_nm - low_nm) / kWavelengthStep_nm));
    record.count = steps + 1;
    record.low_nm = low_nm;
    record.per_nm = static_cast<double>(steps) / (high_nm - low_nm);
    record.last = static_cast<double>(steps);
    for (std::uint32_t i = 0; i <= steps; ++i) tabulate(low_nm + static_cast<double>(i) / record.per_nm);
  }
  media.push_back(record);
}

SceneMedium SceneMedium::opaque(std::string name) {
  optics::Medium nothing;
  nothing.name = std::move(name);
  nothing.index = core::Curve::constant(1.0);
  SceneMedium medium(std::move(nothing));
  medium.opaque_ = true;
  return medium;
}

BoundaryTriangle Scene::triangle(const Region& region, std::uint32_t number) const {
  BoundaryTriangle corners = accelerator(region).triangle(number);
  for (core::Vec3& corner : corners) corner = region.centre + region.direction_to_world(corner);
  return corners;
}

bool Scene::region_contains(core::RegionId region, const core::Vec3& point) const {
  const Region& candidate = regions[region];
  return accelerator(candidate).contains(candidate.point_to_local(point));
}

bool Scene::region_contains(core::RegionId region, const Eigen::AlignedBox3d& box) const {
  if (region == kAmbientRegion || !region_contains(region, core::Vec3(box.center()))) return false;
  constexpr double kRounding = 1e-9;  // of the box's size
  const core::Vec3 slack = core::Vec3::Constant(kRounding * box.diagonal().norm());
  const Eigen::AlignedBox3d inner(box.min() + slack, box.max() - slack);
  const Region& candidate = regions[region];
  if (candidate.curved) {  // of a convex region all of the box is inside where its corners are
    const ExactBodies& exact = accelerator(candidate).boundary().exact;
    if (!exact.held || exact.bodies.size() > 1 || exact.meshed > 0 || !exact.bodies.front().is_convex())
      return false;
    for (unsigned corner = 0; corner < 8; ++corner)
      if (!region_contains(region,
                           core::Vec3(inner.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)))))
        return false;
    return true;
  }
  for (std::uint32_t i = 0; i < accelerator(candidate).size(); ++i) {
    Eigen::AlignedBox3d bounds;
    for (const core::Vec3& vertex : triangle(candidate, i)) bounds.extend(vertex);
    if (inner.intersects(bounds)) return false;
  }
  return true;
}

core::RegionId Scene::locate(const core::Vec3& point) const {
  for (const core::RegionId region : regions.ids())
    if (region != kAmbientRegion && region_contains(region, point)) return region;
  return kAmbientRegion;
}

}  // namespace scintray::scene
