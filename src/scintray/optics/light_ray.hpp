#pragma once
/// A photon's ray as the light of laws over a number type.

#include "scintray/core/triples.hpp"
#include "scintray/optics/fresnel.hpp"
#include "scintray/optics/fresnel_laws.hpp"

namespace scintray::optics {

inline LightRay<double> light_of(const Ray& ray) {
  return {core::triple(ray.direction), core::triple(ray.polarisation)};
}
inline Ray ray_of(const LightRay<double>& light) {
  return {core::vec(light.direction), core::vec(light.polarisation)};
}

}  // namespace scintray::optics
