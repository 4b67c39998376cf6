#include "scintray/surface/fresnel.hpp"

namespace scintray {

namespace {

/// Incidence closer to the normal than this (sine squared) has no plane of incidence worth naming.
constexpr double kNormalIncidence = 1e-20;

/// A ray at a facet: Snell's law.
struct Incidence {
  double cos_i, ratio, sin2_i, sin2_t;
  Incidence(const Ray& ray, const Vec3& m, double n1, double n2)
      : cos_i(std::min(1.0, std::max(0.0, -ray.direction.dot(m)))),
        ratio(n1 / n2),
        sin2_i(1.0 - cos_i * cos_i),
        sin2_t(ratio * ratio * sin2_i) {}
};

void refract(Ray& ray, const Vec3& m, double ratio, double cos_i, double cos_t) {
  ray.direction = (ratio * ray.direction + (ratio * cos_i - cos_t) * m).normalized();
}

}  // namespace

bool meet_facet(Ray& ray, const Vec3& m, double n1, double n2, Rng& rng) {
  const auto [cos_i, ratio, sin2_i, sin2_t] = Incidence(ray, m, n1, n2);
  if (sin2_t >= 1.0) {
    reflect(ray, m);
    return false;
  }
  const double cos_t = std::sqrt(1.0 - sin2_t);
  const double r_s = (n1 * cos_i - n2 * cos_t) / (n1 * cos_i + n2 * cos_t);
  const double r_p = (n2 * cos_i - n1 * cos_t) / (n2 * cos_i + n1 * cos_t);

  if (ray.polarisation.isZero(0.0)) {
    const bool transmitted = rng.uniform() >= 0.5 * (r_s * r_s + r_p * r_p);
    if (transmitted)
      refract(ray, m, ratio, cos_i, cos_t);
    else
      ray.direction = mirror(ray.direction, m);
    return transmitted;
  }

  if (sin2_i < kNormalIncidence) {
    const bool transmitted = rng.uniform() >= r_s * r_s;
    if (!transmitted) reflect(ray, m);
    return transmitted;
  }
  const Vec3 s = ray.direction.cross(m).normalized();
  const Vec3 p_in = s.cross(ray.direction);
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
    ray.direction = mirror(ray.direction, m);
  }
  // p is s x k on every side, so r_p's sign convention (Born & Wolf fig. 1.10) carries over.
  ray.polarisation = (out_s * s + out_p * s.cross(ray.direction)).normalized();
  return transmitted;
}

bool refract_only(Ray& ray, const Vec3& m, double n1, double n2) {
  if (n1 == n2) return true;
  const auto [cos_i, ratio, sin2_i, sin2_t] = Incidence(ray, m, n1, n2);
  if (sin2_t >= 1.0) {
    reflect(ray, m);
    return false;
  }
  const Vec3 before = ray.direction;
  refract(ray, m, ratio, cos_i, std::sqrt(1.0 - sin2_t));
  if (ray.polarisation.isZero(0.0) || sin2_i < kNormalIncidence) return true;
  const Vec3 s = before.cross(m).normalized();
  const double e_s = ray.polarisation.dot(s), e_p = ray.polarisation.dot(s.cross(before));
  ray.polarisation = (e_s * s + e_p * s.cross(ray.direction)).normalized();
  return true;
}

}  // namespace scintray
