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

template <typename Real>
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
    return dot(at.rho, at.rho) + (axial * at.z - Real(2.0) * slope) * at.z - radius2;
  }
  /// Half the gradient of q (mm), which points outwards; zero at the tip of a cone.
  Vector gradient(const Place& at) const { return at.rho + (axial * at.z - slope) * axis; }

  QuadricOnRayOf<Real> on_ray(const Vector& from, const Vector& direction) const {
    const Place at = place(from);
    const Real along = dot(axis, direction);
    const Vector across = direction - along * axis;
    return {dot(across, across) + axial * along * along, dot(at.rho, across) + (axial * at.z - slope) * along,
            value(at)};
  }
  /// Displacement (mm) onto the surface of a point next to it: one step of Newton's method.
  Vector correction(const Vector& point) const {
    using core::select;
    const Place at = place(point);
    const Vector outwards = gradient(at);
    const Real square = dot(outwards, outwards), zero(0.0);
    const auto known = square > zero;
    const Vector step = (Real(-0.5) * value(at) / select(known, square, Real(1.0))) * outwards;
    return select(known, step, Vector{zero, zero, zero});
  }
  /// Unit normal at a point of the surface, outwards; at the tip of a cone, along its axis.
  Vector normal(const Vector& point) const {
    using core::root, core::select;
    const Vector outwards = gradient(place(point));
    const Real length = root(dot(outwards, outwards)), zero(0.0);
    const auto known = length > zero;
    const Vector along = select(slope > zero, -axis, axis);
    return select(known, (Real(1.0) / select(known, length, Real(1.0))) * outwards, along);
  }
};

}  // namespace scintray::mesh
