#pragma once
/// Numbers of the photons in the lanes, in memory, from which single ones are taken.

#include <cstddef>

#include "scintray/core/lanes/lane_fours.hpp"

namespace scintray::transport {
namespace {

template <typename Real>
struct alignas(64) LaneNumbers {
  double of[Real::kWidth];
  Real load() const { return Real::load(of); }
  void store(const Real& value) { value.store(of); }
};

template <typename Real>
struct LaneNumbers3 {
  LaneNumbers<Real> x, y, z;
  core::Triple<Real> load() const { return {x.load(), y.load(), z.load()}; }
  void store(const core::Triple<Real>& value) { x.store(value.x), y.store(value.y), z.store(value.z); }
  void set(std::size_t lane, const double* from) {
    x.of[lane] = from[0], y.of[lane] = from[1], z.of[lane] = from[2];
  }
  void get(std::size_t lane, double* to) const { to[0] = x.of[lane], to[1] = y.of[lane], to[2] = z.of[lane]; }
};

/// The face that light arrives at in each lane.
template <typename Real>
struct LaneArrival {
  core::Triple<Real> normal;  ///< out of the region
  Real cosine;                ///< between normal and light
  Real least_sin2;            ///< as of LaneWork
};

/// Numbers of each lane at a place of its own, without a way through memory.
template <typename Real>
Real load_each(const double* const (&at)[Real::kWidth]) {
  Real ones;
  load_ones(at, ones);
  return ones;
}

}  // namespace
}  // namespace scintray::transport
