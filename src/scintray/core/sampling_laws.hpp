#pragma once
/// Directions from uniform random numbers, over a number type (number.hpp).

#include "scintray/core/elementary_laws.hpp"

namespace scintray::core {

/// Direction uniform over the sphere, from two numbers uniform on [0, 1).
template <typename Real>
Triple<Real> isotropic(const Real& first, const Real& second) {
  const Real cosine = Real(2.0) * first - Real(1.0);
  const Real sine = root(greatest(Real(1.0) - cosine * cosine, Real(0.0)));
  const SineCosineOf<Real> azimuth = laws::sincos_of_turn<Real>(second);
  return {sine * azimuth.cosine, sine * azimuth.sine, cosine};
}

/// Direction about the unit vector `normal` with density cos(theta)/pi per solid angle (Lambert), from two
/// numbers uniform on [0, 1).
template <typename Real>
Triple<Real> lambertian(const Triple<Real>& normal, const Real& sine2, const Real& turn) {
  const Real sine = root(sine2);
  const SineCosineOf<Real> azimuth = laws::sincos_of_turn<Real>(turn);
  const Across<Real> across(normal);
  return (sine * azimuth.cosine) * across.x + (sine * azimuth.sine) * across.y +
         root(Real(1.0) - sine2) * normal;
}

/// Two independent numbers.
template <typename Real>
struct IndependentPair {
  Real first, second;
};

/// Standard normal deviates (Box and Muller 1958), from a number uniform on (0, 1] and one uniform on [0, 1).
template <typename Real>
IndependentPair<Real> normal_deviates(const Real& for_radius, const Real& turn) {
  const Real radius = root(Real(-2.0) * laws::log<Real>(for_radius));
  const SineCosineOf<Real> azimuth = laws::sincos_of_turn<Real>(turn);
  return {radius * azimuth.cosine, radius * azimuth.sine};
}

/// A point of the unit circle, uniform in angle, without trigonometry, from 64 random bits: twice the angle
/// of a point that is uniform in a square, unless that is outside the disc (J. von Neumann 1951, NBS Applied
/// Math. Series 12, 36).
template <typename Real>
struct CirclePoint {
  Real x, y;
  MaskOf<Real> accepted;

  explicit CirclePoint(const BitsOf<Real>& bits)
      : CirclePoint(coordinate(bits & BitsOf<Real>(0xffffffffULL)), coordinate(bits >> 32)) {}

 private:
  CirclePoint(const Real& a, const Real& b) : CirclePoint(a, b, a * a + b * b) {}
  CirclePoint(const Real& a, const Real& b, const Real& r2)
      : x((a * a - b * b) / r2), y(Real(2.0) * a * b / r2), accepted((r2 > Real(0.0)) & (r2 <= Real(1.0))) {}
  /// A signed number of 32 bits, as a share of 2^31.
  static Real coordinate(const BitsOf<Real>& bits) {
    constexpr double kHalf = 0x1.0p31;
    return (value_of<Real>(bits ^ BitsOf<Real>(0x80000000ULL)) - Real(kHalf)) * Real(1.0 / kHalf);
  }
};

/// Unit vector across `direction`, at the azimuth of a point of the unit circle.
template <typename Real>
Triple<Real> across_at(const Triple<Real>& direction, const CirclePoint<Real>& at) {
  const Across<Real> across(direction);
  return at.x * across.x + at.y * across.y;
}

}  // namespace scintray::core
