#include "scintray/optics/fresnel.hpp"

#include "scintray/optics/elliptical.hpp"

namespace scintray::optics {

namespace {

using core::triple;
using core::vec;

LightRay<double> light_of(const Ray& ray) { return {triple(ray.direction), triple(ray.polarisation)}; }
/// Sets direction and polarisation of a ray that keeps no phases.
void set_light(Ray& ray, const LightRay<double>& light) {
  ray.direction = vec(light.direction);
  ray.polarisation = vec(light.polarisation);
}

}  // namespace

bool interact_at_facet(Ray& ray, const core::Vec3& m, double n1, double n2, core::Rng& rng) {
  if (ray.keeps_phases) [[unlikely]]
    return interact_with_phase(ray, m, n1, n2, rng);
  const LightRay<double> light = light_of(ray);
  const core::Triple<double> normal = triple(m);
  const double cos_i = cos_incidence(light, normal);
  const Refraction refraction(cos_i, n1, n2);
  if (refraction.total()) {
    set_light(ray, reflected(light, normal));
    return false;
  }
  FacetLight<double> facet(light, normal, cos_i, refraction, n1, n2);
  if (is_zero(light.polarisation)) {
    const bool transmitted = facet.transmits_unpolarised(rng.uniform());
    ray.direction = vec(transmitted ? facet.refracted() : facet.mirrored());
    return transmitted;
  }
  if (refraction.sin2_i < kNormalIncidence) {
    const bool transmitted = facet.transmits_straight(rng.uniform());
    if (!transmitted) set_light(ray, reflected(light, normal));
    return transmitted;
  }
  const bool transmitted = facet.transmits_polarised(rng.uniform());
  const core::Triple<double> direction = transmitted ? facet.refracted() : facet.mirrored();
  set_light(ray, {direction, facet.polarised(transmitted, direction)});
  return transmitted;
}

bool refract_only(Ray& ray, const core::Vec3& m, double n1, double n2) {
  if (n1 == n2) return true;
  const LightRay<double> light = light_of(ray);
  const core::Triple<double> normal = triple(m);
  const double cos_i = cos_incidence(light, normal);
  const Refraction refraction(cos_i, n1, n2);
  if (refraction.total()) {
    set_light(ray, reflected(light, normal));
    return false;
  }
  const core::Vec3 before = ray.direction;
  ray.direction = vec(FacetLight<double>(light, normal, cos_i, refraction, n1, n2).refracted());
  if (ray.polarisation.isZero(0.0) || refraction.sin2_i < kNormalIncidence) return true;
  const core::Vec3 s = before.cross(m).normalized();
  if (ray.keeps_phases) [[unlikely]] {
    Ray at_incidence = ray;
    at_incidence.direction = before;
    set_field(ray, s, field_of(at_incidence, s));
    return true;
  }
  const double e_s = ray.polarisation.dot(s), e_p = ray.polarisation.dot(s.cross(before));
  ray.polarisation = (e_s * s + e_p * s.cross(ray.direction.vec())).normalized();
  return true;
}

}  // namespace scintray::optics
