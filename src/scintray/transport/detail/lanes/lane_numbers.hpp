#pragma once
/// Numbers of the photons in the lanes, in memory between passes.

#include <cstddef>

#include "scintray/core/number.hpp"

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
  void copy(std::size_t from, std::size_t to) {
    x.of[to] = x.of[from], y.of[to] = y.of[from], z.of[to] = z.of[from];
  }
  void get(std::size_t lane, double* to) const { to[0] = x.of[lane], to[1] = y.of[lane], to[2] = z.of[lane]; }
};

/// Normal, out of the region, of the face that light arrives at in each lane, and the cosine between the two.
template <typename Real>
struct LaneIncidence {
  core::Triple<Real> normal;
  Real cosine;
};

}  // namespace
}  // namespace scintray::transport
