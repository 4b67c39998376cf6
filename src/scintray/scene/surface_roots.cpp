#include <algorithm>
#include <cmath>
#include <span>

#include "scintray/scene/detail/surface_roots.hpp"

namespace scintray::scene {

namespace {

/// A polynomial; coefficients from the constant upwards.
using Polynomial = std::array<double, 5>;

double value_at(const Polynomial& p, std::size_t degree, double t) {
  double sum = p[degree];
  for (std::size_t i = degree; i-- > 0;) sum = sum * t + p[i];
  return sum;
}

/// Root between two places of opposite sign: Newton's method, and bisection where that leaves the bracket.
double root_between(const Polynomial& p, const Polynomial& slope, std::size_t degree, double low,
                    double high) {
  const bool rises = value_at(p, degree, high) > 0.0;
  double t = 0.5 * (low + high);
  for (int step = 0; step < 200; ++step) {
    const double f = value_at(p, degree, t);
    if (f == 0.0) return t;
    ((f > 0.0) == rises ? high : low) = t;
    const double next = t - f / value_at(slope, degree - 1, t);
    const double before = t;
    t = next > low && next < high ? next : 0.5 * (low + high);
    if (t == before || !(high - low > 1e-16 * (std::abs(low) + std::abs(high)))) break;
  }
  return t;
}

/// A simple root, and whether the polynomial rises there.
struct PolynomialRoot {
  double at;
  bool rises;
};

struct PolynomialRoots {
  std::array<PolynomialRoot, 4> list;
  std::size_t count = 0;
};

/// Roots in [low, high] at which the sign changes, in order: between the roots of the derivative.
PolynomialRoots roots_of(const Polynomial& p, std::size_t degree, double low, double high) {
  PolynomialRoots roots;
  Polynomial slope{};
  for (std::size_t i = 1; i <= degree; ++i) slope[i - 1] = static_cast<double>(i) * p[i];
  PolynomialRoots turns;
  if (degree > 1) turns = roots_of(slope, degree - 1, low, high);
  double from = low, at_from = value_at(p, degree, low);
  for (std::size_t i = 0; i <= turns.count; ++i) {
    const double to = i < turns.count ? turns.list[i].at : high;
    const double at_to = value_at(p, degree, to);
    if ((at_from < 0.0) != (at_to < 0.0))
      roots.list[roots.count++] = {root_between(p, slope, degree, from, to), at_to > at_from};
    from = to;
    at_from = at_to;
  }
  return roots;
}

/// Brings a root onto the torus by Newton's method on the distance, which has more digits than the quartic.
double polished(const mesh::SupportSurface& torus, const core::Vec3& origin, const core::Vec3& direction,
                double distance) {
  for (int step = 0; step < 2; ++step) {
    const core::Vec3 point = origin + distance * direction;
    const core::Vec3 outwards = torus.gradient(point);
    const double along = outwards.dot(direction), length = outwards.norm();
    if (!(std::abs(along) > 1e-6 * length)) break;
    distance -= (length - std::sqrt(torus.radius2)) * length / along;
  }
  return distance;
}

}  // namespace

Crossings torus_crossings(const mesh::SupportSurface& torus, const core::Vec3& origin,
                          const core::Vec3& direction, bool on_it, double low, double high) {
  Crossings result;
  const double start = on_it ? 0.0 : std::max(low, 0.0);  // of the polynomial, next to the torus
  const core::Vec3 w = origin + start * direction - torus.origin;
  const double z = torus.axis.dot(w), dz = torus.axis.dot(direction), along = w.dot(direction),
               w2 = w.squaredNorm(), four_r2 = 4.0 * torus.major * torus.major;
  // (|p|^2 + R^2 - r^2)^2 - 4 R^2 (|p|^2 - z^2), of p = w + t d.
  const double k = w2 + 0.25 * four_r2 - torus.radius2;
  Polynomial p{k * k - four_r2 * (w2 - z * z), 4.0 * along * k - 2.0 * four_r2 * (along - z * dz),
               4.0 * along * along + 2.0 * k - four_r2 * (1.0 - dz * dz), 4.0 * along, 1.0};
  std::size_t degree = 4;
  if (on_it) {  // without the root at 0
    for (std::size_t i = 0; i < 4; ++i) p[i] = p[i + 1];
    degree = 3;
  }
  const PolynomialRoots roots = roots_of(p, degree, low - start, high - start);
  for (std::size_t i = 0; i < roots.count; ++i) {
    const PolynomialRoot& root = roots.list[i];
    const bool rises = on_it && root.at < 0.0 ? !root.rises : root.rises;
    result.add(polished(torus, origin, direction, start + root.at), rises);
  }
  return result;
}

}  // namespace scintray::scene
