#pragma once
/// Points at which a ray crosses a support surface.

#include <array>
#include <cstddef>

#include "scintray/scene/exact_bodies.hpp"

namespace scintray::scene {

/// A crossing of a surface: its distance (mm) along the ray, and whether the ray leaves the surface's inside
/// there.
struct Crossing {
  double distance_mm;
  bool leaves;
};

struct Crossings {
  std::array<Crossing, 4> at;
  std::size_t count = 0;

  void add(double distance_mm, bool leaves) { at[count++] = {distance_mm, leaves}; }
  const Crossing* begin() const { return at.data(); }
  const Crossing* end() const { return at.data() + count; }
};

/// All crossings of a quadric, in no order. Where the ray starts on it, known to be a root at 0, `on_it`,
/// that root is left out.
inline Crossings quadric_crossings(QuadricOnRay q, bool on_it) {
  Crossings result;
  if (on_it) q.c = 0.0;
  const double discriminant = q.b * q.b - q.a * q.c;
  if (!(discriminant > 0.0)) return result;
  const double root = std::copysign(std::sqrt(discriminant), q.b), sum = -(q.b + root);
  // At sum / a half the derivative of q is -root, at c / sum it is root.
  if (q.a != 0.0) result.add(sum / q.a, root < 0.0);
  if (!on_it) result.add(q.c / sum, root > 0.0);
  return result;
}

/// All crossings of a torus within distances (mm) from low to high, as quadric_crossings.
Crossings torus_crossings(const mesh::SupportSurface& torus, const core::Vec3& origin,
                          const core::Vec3& direction, bool on_it, double low, double high);

}  // namespace scintray::scene
