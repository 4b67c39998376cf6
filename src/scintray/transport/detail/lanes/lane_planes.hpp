#pragma once
/// The plane through which a ray in each lane leaves a convex region, computed as for one ray in
/// scene/detail/nearest_plane.hpp: the same numbers, in the same order.

#include <limits>

#include "scintray/core/lanes/lane_number.hpp"

namespace scintray::transport {
namespace {

/// Of two planes, in each lane.
template <typename Real>
struct LaneTaken {
  core::MaskOf<Real> closer, first;
};

/// The nearest plane so far, the distance (mm) to it, and the cosine between ray and normal.
template <typename Real>
struct LaneAhead {
  Real distance_mm{std::numeric_limits<double>::infinity()};
  Real plane{0.0}, cosine{0.0};

  /// Takes two opposite planes, with the numbers `first` and `first` + 1.
  /// @param normal     of the first one
  /// @param first_mm   product of its normal and any point of it
  /// @param second_mm  likewise of the other, whose normal is the opposite; infinite: there is none
  /// @param from       the ray's origin
  /// @return which lanes these planes are nearer in, and of which the first one is ahead
  LaneTaken<Real> take(const core::Triple<Real>& normal, const Real& first_mm, const Real& second_mm,
                       const core::Triple<Real>& from, const core::Triple<Real>& direction, double first) {
    const Real signed_along = dot(normal, direction), height = dot(normal, from);
    const auto along_first = signed_along > Real(0.0);
    const Real along = magnitude(signed_along), one(1.0), zero(0.0);
    const Real distance =
        greatest(select(along_first, first_mm - height, second_mm + height), zero) * (one / along);
    const auto closer = distance < distance_mm;
    distance_mm = select(closer, distance, distance_mm);
    plane = select(closer, select(along_first, Real(first), Real(first + 1.0)), plane);
    cosine = select(closer, along, cosine);
    return {closer, along_first};
  }
};

}  // namespace
}  // namespace scintray::transport
