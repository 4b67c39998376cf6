#pragma once
/// Total reflection at the boundaries of regions: where it depends on the angle of incidence alone, and draws
/// no random number.

#include "scintray/scene/scene.hpp"

namespace scintray::scene {

/// Value above every sine squared: there is no total reflection.
inline constexpr double kNeverTotal = 2.0;

/// sin^2 of the critical angle from a refractive index to another; above 1 without total reflection.
inline double critical_sin2(double index_here, double index_behind) {
  const double ratio = index_behind / index_here;
  return ratio * ratio;
}

/// What decides on total reflection of the light that leaves a region through one of its boundary's
/// triangles.
TotalReflection total_reflection(const Scene& scene, const BoundaryLink& link);

/// Sine squared of the angle of incidence from which light is totally reflected.
/// @param index_here  refractive index of the region of incidence at the wavelength
double least_sin2(const Scene& scene, const TotalReflection& at, double index_here, double wavelength_nm);

}  // namespace scintray::scene
