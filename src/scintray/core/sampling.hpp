#pragma once
/// Sampling of directions, lengths and deviates for light transport.

#include <algorithm>
#include <cstdint>

#include "scintray/core/elementary.hpp"
#include "scintray/core/normals.hpp"
#include "scintray/core/rng.hpp"
#include "scintray/core/sampling_laws.hpp"
#include "scintray/core/vec.hpp"

namespace scintray::core {

/// Direction uniform over the sphere.
inline Vec3 sample_isotropic(Rng& rng) {
  const double first = rng.uniform();
  return vec(isotropic<double>(first, rng.uniform()));
}

/// Unit vector at the polar angle of cosine `cosine` from the unit vector `axis`, at an azimuth about it.
inline Vec3 turned(const Vec3& axis, double cosine, double azimuth_rad) {
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  const Frame frame = Frame::about(axis);
  return (sine * std::cos(azimuth_rad) * frame.x + sine * std::sin(azimuth_rad) * frame.y + cosine * frame.z)
      .normalized();
}

/// Direction about the unit vector `normal` with density cos(theta)/pi per solid angle (Lambert).
inline Vec3 sample_lambertian(const Vec3& normal, Rng& rng) {
  const double sine2 = rng.uniform();
  return vec(lambertian<double>(triple(normal), sine2, rng.uniform()));
}

/// A point of the unit circle, uniform in angle.
inline CirclePoint<double> sample_circle(Rng& rng) {
  for (;;)
    if (const CirclePoint<double> point(rng.bits()); point.accepted) return point;
}

/// Unit vector perpendicular to `direction`, uniform in azimuth: the polarisation of unpolarised light.
inline Vec3 sample_polarisation(const Vec3& direction, Rng& rng) {
  return vec(across_at<double>(triple(direction), sample_circle(rng)));
}

/// Exponential deviate with mean 1.
inline double sample_exponential(Rng& rng) { return -log(rng.uniform_positive()); }

/// Gamma deviate with mean 1 and standard deviation `spread` above 0 (G. Marsaglia and W. W. Tsang 2000,
/// ACM Trans. Math. Softw. 26, 363; shapes below 1 as in its section 6).
inline double sample_gamma(double spread, Rng& rng) {
  const double shape = 1.0 / (spread * spread);
  const double d = (shape < 1.0 ? shape + 1.0 : shape) - 1.0 / 3.0;
  for (;;) {
    const double x = sample_normal(rng);
    const double root = 1.0 + x / std::sqrt(9.0 * d);
    if (root <= 0.0) continue;
    const double v = root * root * root;
    if (-sample_exponential(rng) >= 0.5 * x * x + d - d * v + d * std::log(v)) continue;
    const double boost = shape < 1.0 ? std::exp(-sample_exponential(rng) / shape) : 1.0;
    return d * v * boost / shape;
  }
}

}  // namespace scintray::core
