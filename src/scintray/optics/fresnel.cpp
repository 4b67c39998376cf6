#include "scintray/optics/fresnel.hpp"

#include "scintray/optics/elliptical.hpp"

namespace scintray::optics {

namespace {

/// Sine squared of the angle of incidence below which the plane of incidence is numerically undefined.
constexpr double kNormalIncidence = 1e-20;

/// Cosine of incidence of a ray at a facet with normal m against it.
double cos_incidence(const Ray& ray, const core::Vec3& m) {
  return std::min(1.0, std::max(0.0, -ray.direction.dot(m)));
}

void refract(Ray& ray, const core::Vec3& m, double ratio, double cos_i, double cos_t) {
  ray.direction = (ratio * ray.direction + (ratio * cos_i - cos_t) * m).normalized();
}

}  // namespace

bool interact_at_facet(Ray& ray, const core::Vec3& m, double n1, double n2, core::Rng& rng) {
  if (ray.keeps_phases) [[unlikely]]
    return interact_with_phase(ray, m, n1, n2, rng);
  const double cos_i = cos_incidence(ray, m);
  const Refraction refraction(cos_i, n1, n2);
  if (refraction.total()) {
    reflect(ray, m);
    return false;
  }
  const double ratio = refraction.ratio, cos_t = refraction.cos_t();
  const auto [r_s, r_p] = FresnelAmplitudes(cos_i, cos_t, n1, n2);

  if (ray.polarisation.isZero(0.0)) {
    const bool transmitted = rng.uniform() >= 0.5 * (r_s * r_s + r_p * r_p);
    if (transmitted)
      refract(ray, m, ratio, cos_i, cos_t);
    else
      ray.direction = core::mirror(ray.direction, m);
    return transmitted;
  }

  if (refraction.sin2_i < kNormalIncidence) {
    const bool transmitted = rng.uniform() >= r_s * r_s;
    if (!transmitted) reflect(ray, m);
    return transmitted;
  }
  const core::Vec3 s = ray.direction.cross(m).normalized();
  const core::Vec3 p_in = s.cross(ray.direction.vec());
  const double e_s = ray.polarisation.dot(s);
  const double e_p = ray.polarisation.dot(p_in);
  const double power = e_s * e_s + e_p * e_p;
  const double reflectance = (r_s * r_s * e_s * e_s + r_p * r_p * e_p * e_p) / power;
  const bool transmitted = rng.uniform() >= reflectance;
  double out_s, out_p;
  if (transmitted) {
    out_s = (1.0 + r_s) * e_s;
    out_p = ratio * (1.0 + r_p) * e_p;  // t_p = (n1/n2)(1 + r_p), same convention
    refract(ray, m, ratio, cos_i, cos_t);
  } else {
    out_s = r_s * e_s;
    out_p = r_p * e_p;
    ray.direction = core::mirror(ray.direction, m);
  }
  // p is s x k on every side, so r_p's sign convention (Born & Wolf fig. 1.10) carries over.
  ray.polarisation = (out_s * s + out_p * s.cross(ray.direction.vec())).normalized();
  return transmitted;
}

bool refract_only(Ray& ray, const core::Vec3& m, double n1, double n2) {
  if (n1 == n2) return true;
  const double cos_i = cos_incidence(ray, m);
  const Refraction refraction(cos_i, n1, n2);
  if (refraction.total()) {
    reflect(ray, m);
    return false;
  }
  const core::Vec3 before = ray.direction;
  refract(ray, m, refraction.ratio, cos_i, refraction.cos_t());
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
