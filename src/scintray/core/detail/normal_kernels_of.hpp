#pragma once
/// The kernel of normal_kernels.hpp for one instruction set. Included by one file for each.

#include "scintray/core/detail/normal_kernels.hpp"
#include "scintray/core/elementary_laws.hpp"
#include "scintray/core/lanes/lane_number.hpp"
#include "scintray/core/sampling_laws.hpp"

namespace scintray::core {
namespace {

template <typename Real>
[[gnu::flatten, gnu::always_inline]] inline void set_normals(NormalLanes& lanes) {
  using Bits = BitsOf<Real>;
  constexpr std::size_t kWidth = Real::kWidth;
  static_assert(NormalLanes::kPairs % kWidth == 0);
  for (std::size_t i = 0; i < NormalLanes::kPairs; i += kWidth) {
    const IndependentPair<Real> pairs =
        normal_deviates<Real>(uniform_positive_of<Real>(Bits::load(lanes.for_radius + i)),
                              uniform_of<Real>(Bits::load(lanes.turn + i)));
    alignas(64) double first[kWidth], second[kWidth];
    pairs.first.store(first);
    pairs.second.store(second);
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
      lanes.deviates[2 * (i + lane)] = first[lane];
      lanes.deviates[2 * (i + lane) + 1] = second[lane];
    }
  }
}

}  // namespace
}  // namespace scintray::core
