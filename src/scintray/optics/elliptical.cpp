#include "scintray/optics/elliptical.hpp"

#include <algorithm>
#include <cmath>

namespace scintray::optics {

namespace {

using Complex = std::complex<double>;

/// Sine squared of the angle of incidence below which the plane of incidence is numerically undefined.
constexpr double kHeadOn_sin2 = 1e-20;

/// Real and imaginary part of a field, in space.
struct SpaceField {
  core::Vec3 real, imaginary;
};

SpaceField space_field(const Ray& ray) {
  const core::Vec3 a = ray.polarisation.vec(), b = ray.direction.vec().cross(a);
  return {std::cos(ray.ellipticity_rad) * a, std::sin(ray.ellipticity_rad) * b};
}

/// Sets the state of a ray of its new direction, across which the field lies. The axes of the ellipse are the
/// real and the imaginary part once the phase is chosen that makes the square of the field real and positive.
void set_space_field(Ray& ray, const SpaceField& field) {
  const Complex square(field.real.squaredNorm() - field.imaginary.squaredNorm(),
                       2.0 * field.real.dot(field.imaginary));
  const double phase = 0.5 * std::arg(square);
  const double cosine = std::cos(phase), sine = std::sin(phase);
  const core::Vec3 major = cosine * field.real + sine * field.imaginary;
  const core::Vec3 minor = cosine * field.imaginary - sine * field.real;
  const double length = major.norm();
  ray.polarisation = major / length;
  const core::Vec3 across = ray.direction.vec().cross(ray.polarisation.vec());
  ray.ellipticity_rad = std::atan2(minor.dot(across), length);
}

}  // namespace

FieldComponents field_of(const Ray& ray, const core::Vec3& s) {
  const SpaceField field = space_field(ray);
  const core::Vec3 p = s.cross(ray.direction.vec());
  return {{field.real.dot(s), field.imaginary.dot(s)}, {field.real.dot(p), field.imaginary.dot(p)}};
}

void set_field(Ray& ray, const core::Vec3& s, const FieldComponents& field) {
  const core::Vec3 p = s.cross(ray.direction.vec());
  set_space_field(ray, {field.s.real() * s + field.p.real() * p, field.s.imag() * s + field.p.imag() * p});
}

bool project_field(Ray& ray, const core::Vec3& direction) {
  SpaceField field = space_field(ray);
  for (core::Vec3* part : {&field.real, &field.imaginary}) *part -= part->dot(direction) * direction;
  constexpr double kLeast = 1e-9;
  if (field.real.norm() + field.imaginary.norm() < kLeast) return false;
  ray.direction = direction;
  set_space_field(ray, field);
  return true;
}

double draw_sign(const std::complex<double>& s, const std::complex<double>& p, core::Rng& rng) {
  const double size = std::abs(s) * std::abs(p);
  const double in_phase = size > 0.0 ? (p * std::conj(s)).real() / size : 1.0;
  return rng.uniform() < 0.5 * (1.0 + in_phase) ? 1.0 : -1.0;
}

double power_across(const Ray& ray, const core::Vec3& direction) {
  const SpaceField field = space_field(ray);
  return 1.0 - std::norm(Complex(field.real.dot(direction), field.imaginary.dot(direction)));
}

StokesParameters stokes_of(const Ray& ray, const core::Vec3& s) {
  const FieldComponents field = field_of(ray, s);
  // With s x k = p the axes (s, p, k) are left-handed: chi, which turns from a to k x a, counts from p to s.
  const Complex product = field.s * std::conj(field.p);
  return {std::norm(field.s) - std::norm(field.p), 2.0 * product.real(), 2.0 * product.imag()};
}

FieldComponents total_reflection_amplitudes(double cos_i, double n1, double n2) {
  const Refraction refraction(cos_i, n1, n2);
  const Complex cos_t(0.0, std::sqrt(std::max(0.0, refraction.sin2_t - 1.0)));
  return {(n1 * cos_i - n2 * cos_t) / (n1 * cos_i + n2 * cos_t),
          (n2 * cos_i - n1 * cos_t) / (n2 * cos_i + n1 * cos_t)};
}

bool interact_with_phase(Ray& ray, const core::Vec3& m, double n1, double n2, core::Rng& rng) {
  const double cos_i = std::clamp(-ray.direction.dot(m), 0.0, 1.0);
  const Refraction refraction(cos_i, n1, n2);
  if (refraction.sin2_i < kHeadOn_sin2) {
    const double r = (n1 - n2) / (n1 + n2);
    const bool transmitted = rng.uniform() >= r * r;
    if (!transmitted) reflect(ray, m);
    return transmitted;
  }
  const core::Vec3 s = ray.direction.cross(m).normalized();
  FieldComponents field = field_of(ray, s);
  if (refraction.total()) {
    const FieldComponents r = total_reflection_amplitudes(cos_i, n1, n2);
    ray.direction = core::mirror(ray.direction, m);
    set_field(ray, s, {r.s * field.s, r.p * field.p});
    return false;
  }
  const double cos_t = refraction.cos_t(), ratio = refraction.ratio;
  const auto [r_s, r_p] = FresnelAmplitudes(cos_i, cos_t, n1, n2);
  const double power_s = std::norm(field.s), power_p = std::norm(field.p);
  const double reflectance = (r_s * r_s * power_s + r_p * r_p * power_p) / (power_s + power_p);
  const bool transmitted = rng.uniform() >= reflectance;
  if (transmitted) {
    field = {(1.0 + r_s) * field.s, ratio * (1.0 + r_p) * field.p};
    ray.direction = (ratio * ray.direction + (ratio * cos_i - cos_t) * m).normalized();
  } else {
    field = {r_s * field.s, r_p * field.p};
    ray.direction = core::mirror(ray.direction, m);
  }
  set_field(ray, s, field);
  return transmitted;
}

}  // namespace scintray::optics
