#pragma once
/// Sampling of the directions and lengths that light transport needs.

#include "scintray/core/philox.hpp"
#include "scintray/core/vec.hpp"

namespace scintray {

/// Direction uniform over the sphere.
inline Vec3 sample_isotropic(Rng& rng) {
  const double cosine = 2.0 * rng.uniform() - 1.0;
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  const double azimuth = kTwoPi * rng.uniform();
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

/// Direction about the unit vector `normal` with density cos(theta)/pi per solid angle (Lambert).
inline Vec3 sample_lambertian(const Vec3& normal, Rng& rng) {
  const double sine2 = rng.uniform();
  const double sine = std::sqrt(sine2);
  const double azimuth = kTwoPi * rng.uniform();
  const Frame frame = Frame::about(normal);
  return sine * std::cos(azimuth) * frame.x + sine * std::sin(azimuth) * frame.y +
         std::sqrt(1.0 - sine2) * frame.z;
}

/// Unit vector across `direction`, uniform in azimuth: the polarisation of unpolarised light.
inline Vec3 sample_polarisation(const Vec3& direction, Rng& rng) {
  const Frame frame = Frame::about(direction);
  const double azimuth = kTwoPi * rng.uniform();
  return std::cos(azimuth) * frame.x + std::sin(azimuth) * frame.y;
}

/// Exponential deviate with mean 1.
inline double sample_exponential(Rng& rng) { return -std::log(rng.uniform_positive()); }

/// Standard normal deviate (Box and Muller 1958).
inline double sample_normal(Rng& rng) {
  const double radius = std::sqrt(-2.0 * std::log(rng.uniform_positive()));
  return radius * std::cos(kTwoPi * rng.uniform());
}

}  // namespace scintray
