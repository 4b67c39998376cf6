#include "scintray/scene/total_reflection.hpp"

#include <bit>
#include <cstdint>

#include "scintray/scene/lane_surface_at.hpp"

namespace scintray::scene {

namespace {

/// The number that is `steps` numbers of double precision above a positive one.
double next_to(double positive, std::int64_t steps) {
  return std::bit_cast<double>(std::bit_cast<std::int64_t>(positive) + steps);
}

/// The least 1 - cosine^2 for which Fresnel's equations (optics::RefractionOf) find total reflection, to the
/// last bit. Products of positive numbers are monotonic, so that there is one.
double least_sin2_of_fresnel(double n1, double n2) {
  const double ratio = n1 / n2, ratio2 = ratio * ratio;
  if (!(ratio2 > 1.0)) return kNeverTotal;
  double least = 1.0 / ratio2;
  while (ratio2 * least < 1.0) least = next_to(least, 1);
  while (ratio2 * next_to(least, -1) >= 1.0) least = next_to(least, -1);
  return least;
}

}  // namespace

TotalReflection total_reflection(const Scene& scene, const BoundaryLink& link) {
  TotalReflection at;
  const Interface& interface = scene.interfaces[link.interface];
  if (interface.plain) {
    const core::MediumId behind = scene.regions[scene.behind(link)].medium;
    if (scene.keeps_phases || scene.optics.is_opaque(behind)) return at;
    at.by = TotalReflection::By::critical_angle;
    at.behind = behind;
    return at;
  }
  const std::optional<optics::LaneSurface> surface = lane_surface_at(scene, link);
  if (!surface || surface->micro != optics::LaneSurface::Micro::smooth) return at;
  at.behind = medium_behind_surface(scene, link);
  const core::SurfaceId first = first_surface(interface, link.from_back).id;
  if (surface->reflector && scene.surfaces[first].reflector) at.gap_of = first;
  if (at.gap_of.has_value() || at.behind.has_value()) at.by = TotalReflection::By::fresnel;
  return at;
}

double least_sin2(const Scene& scene, const TotalReflection& at, double index_here, double wavelength_nm) {
  if (at.by == TotalReflection::By::nothing) return kNeverTotal;
  const double behind = at.gap_of.has_value() ? scene.surfaces[at.gap_of].gap_index(wavelength_nm)
                                              : scene.optics.index(at.behind, wavelength_nm);
  return at.by == TotalReflection::By::critical_angle ? critical_sin2(index_here, behind)
                                                      : least_sin2_of_fresnel(index_here, behind);
}

}  // namespace scintray::scene
