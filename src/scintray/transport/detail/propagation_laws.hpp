#pragma once
/// Laws of propagation between boundaries, for one photon and for one in each lane of a vector. No Eigen: the
/// files of the lanes are compiled for instruction sets of their own.

#include "scintray/core/number.hpp"

namespace scintray::transport {

/// Time of light along a unit of path in vacuum, ns/mm: the inverse of core::kSpeedOfLight_mm_per_ns.
inline constexpr double kTimePerLength_ns_per_mm = 1.0 / 299.792458;

/// Time of flight (ns) along a path, at the group velocity.
template <typename Real>
Real time_along(const Real& distance_mm, const Real& group_index) {
  return distance_mm * (group_index * Real(kTimePerLength_ns_per_mm));
}

/// True where a smooth boundary reflects totally.
/// @param cosine      of incidence
/// @param least_sin2  sine squared of the critical angle, above 1 where there is none
template <typename Real>
core::MaskOf<Real> totally_reflected(const Real& cosine, const Real& least_sin2) {
  return Real(1.0) - cosine * cosine >= least_sin2;
}

}  // namespace scintray::transport
