#pragma once
/// A photon's ray as the light of laws over a number type.

#include "scintray/core/triples.hpp"
#include "scintray/optics/fresnel.hpp"
#include "scintray/optics/fresnel_laws.hpp"

namespace scintray::optics {

inline LightRay<double> light_of(const Ray& ray) {
  return {core::triple(ray.direction), core::triple(ray.polarisation)};
}
/// Sets direction and polarisation of a ray that keeps no phases.
inline void set_light(Ray& ray, const LightRay<double>& light) {
  ray.direction = core::vec(light.direction);
  ray.polarisation = core::vec(light.polarisation);
}

}  // namespace scintray::optics
