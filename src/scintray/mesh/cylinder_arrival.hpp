#pragma once
/// Where a ray has reached a cylinder, over a number type (core/number.hpp).

#include "scintray/mesh/quadric_laws.hpp"

namespace scintray::mesh {

/// As QuadricOf::nearest of a cylinder, at a point that is off it by rounding alone, as one at a root of a
/// ray: without a root and a division. The inverse of the distance rho from the axis, of which the square
/// differs from the radius' by v, is (1 - v / (2 radius^2)) / radius but for a share of 3/8 (v / radius^2)^2.
/// @param inverse_radius  1 over the radius, 1/mm
template <typename Real, QuadricShape kShape>
FootOf<Real> arrival_on_cylinder(const QuadricOf<Real, kShape>& cylinder, const Real& inverse_radius,
                                 const core::Triple<Real>& point) {
  const core::Triple<Real> rho = cylinder.place(point).rho;
  const Real height = Real(0.5) * (dot(rho, rho) - cylinder.radius2) * inverse_radius;
  const core::Triple<Real> normal = (inverse_radius * (Real(1.0) - height * inverse_radius)) * rho;
  return {-height * normal, normal};
}

}  // namespace scintray::mesh
