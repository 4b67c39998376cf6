#pragma once
/// Quadrics of revolution over a number type (core/number.hpp): intersection with a ray from inside, and
/// projection of a nearby point. SupportSurface (support_surface.hpp) describes their numbers.

#include <limits>

#include "scintray/core/number.hpp"

namespace scintray::mesh {

/// q along a ray, with t the distance (mm): q(t) = a t^2 + 2 b t + c.
template <typename Real>
struct QuadricOnRayOf {
  Real a, b, c;
};

/// Distance (mm) at which a ray from inside a convex quadric, or from a point on it, leaves it; infinite
/// where it does not. The origin is inside, so that c <= 0 except for rounding, and exactly one root is
/// ahead: with c = 0 for the surface at which the ray has just been reflected, it is the other root, -2 b /
/// a, or 0 for a ray that points outwards.
template <typename Real>
Real distance_out(const QuadricOnRayOf<Real>& q) {
  using core::greatest, core::root, core::select;
  const Real zero(0.0);
  const Real square = root(greatest(q.b * q.b - q.a * q.c, zero));
  const auto outwards = q.b > zero;
  const Real distance =
      greatest(select(outwards, -q.c, square - q.b) / select(outwards, q.b + square, q.a), zero);
  return select(outwards | (q.a > zero), distance, Real(std::numeric_limits<double>::infinity()));
}

/// A point next to a surface: displacement (mm) onto the surface, and its unit normal there, outwards.
template <typename Real>
struct FootOf {
  core::Triple<Real> step, normal;
};

/// What is known of a quadric when a function of it is compiled: of a cylinder `axial` and `slope` are 0, and
/// what they are factors of is left out, which changes no number.
enum class QuadricShape { any, cylinder };

template <typename Real, QuadricShape kShape = QuadricShape::any>
struct QuadricOf {
  using Vector = core::Triple<Real>;
  Vector origin, axis;
  Real axial, slope, radius2;

  /// A point in the quadric's frame.
  struct Place {
    Vector rho;  ///< from the axis
    Real z;
  };
  Place place(const Vector& point) const {
    const Vector from_origin = point - origin;
    const Real z = dot(axis, from_origin);
    return {from_origin - z * axis, z};
  }
  Real value(const Place& at) const {
    if constexpr (kShape == QuadricShape::cylinder) return dot(at.rho, at.rho) - radius2;
    return dot(at.rho, at.rho) + (axial * at.z - Real(2.0) * slope) * at.z - radius2;
  }
  /// Half the gradient of q (mm), which points outwards; zero at the tip of a cone.
  Vector gradient(const Place& at) const {
    if constexpr (kShape == QuadricShape::cylinder) return at.rho;
    return at.rho + (axial * at.z - slope) * axis;
  }

  QuadricOnRayOf<Real> on_ray(const Vector& from, const Vector& direction) const {
    const Place at = place(from);
    const Real along = dot(axis, direction);
    const Vector across = direction - along * axis;
    if constexpr (kShape == QuadricShape::cylinder)
      return {dot(across, across), dot(at.rho, across), value(at)};
    return {dot(across, across) + axial * along * along, dot(at.rho, across) + (axial * at.z - slope) * along,
            value(at)};
  }
  /// Of a point next to the surface: the displacement (mm) onto it, by one step of Newton's method along the
  /// gradient, and the unit normal there, outwards; at the tip of a cone no displacement, and along its axis.
  /// The normal is that of the gradient before the step, from which the one after it differs by less than
  /// rounding, as the step is of the order of rounding itself.
  FootOf<Real> nearest(const Vector& point) const {
    using core::root, core::select;
    const Place at = place(point);
    const Vector outwards = gradient(at);
    const Real square = dot(outwards, outwards), zero(0.0), one(1.0);
    const auto known = square > zero;
    const Real inverse = one / root(select(known, square, one));
    const Vector normal = inverse * outwards;
    const Real height = Real(0.5) * value(at) * inverse;
    if constexpr (kShape == QuadricShape::cylinder) return {-height * normal, normal};
    const Vector along = select(slope > zero, -axis, axis);
    return {select(known, -height * normal, Vector{zero, zero, zero}), select(known, normal, along)};
  }
};

}  // namespace scintray::mesh
