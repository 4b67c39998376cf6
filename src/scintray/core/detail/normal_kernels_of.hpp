#pragma once
/// The kernel of normal_kernels.hpp for one instruction set. Included by one file for each.

#include "scintray/core/detail/normal_kernels.hpp"
#include "scintray/core/elementary_laws.hpp"
#include "scintray/core/lanes/lane_fours.hpp"
#include "scintray/core/philox_laws.hpp"
#include "scintray/core/sampling_laws.hpp"

namespace scintray::core {
namespace {

template <typename Real>
[[gnu::flatten, gnu::always_inline]] inline void draw_normals(NormalLanes& lanes) {
  using Bits = BitsOf<Real>;
  constexpr std::size_t kWidth = Real::kWidth;
  static_assert(NormalLanes::kBlocks % kWidth == 0 && NormalLanes::kDeviates % kWidth == 0);
  alignas(64) std::uint64_t steps[kWidth];
  for (std::size_t lane = 0; lane < kWidth; ++lane) steps[lane] = lane;
  const Bits step = Bits::load(steps);
  for (std::size_t first = 0; first < NormalLanes::kBlocks; first += kWidth) {
    const PhiloxBlock<Bits> block({Bits(lanes.counter[0] + first) + step, Bits(lanes.counter[1]),
                                   Bits(lanes.counter[2]), Bits(lanes.counter[3])},
                                  core::PhiloxKeys<std::uint64_t>(lanes.key[0], lanes.key[1]));
    std::uint64_t* to[kWidth];
    for (std::size_t lane = 0; lane < kWidth; ++lane)
      to[lane] = lanes.numbers + NormalLanes::kLeft + 4 * (first + lane);
    store_fours(block.words, to, to);
  }
  const std::uint64_t* const numbers = lanes.numbers + NormalLanes::kLeft - lanes.left;
  alignas(64) std::uint64_t radius[NormalLanes::kDeviates], turn[NormalLanes::kDeviates];
  for (std::size_t i = 0; i < NormalLanes::kDeviates; ++i) {
    radius[i] = numbers[2 * i];
    turn[i] = numbers[2 * i + 1];
  }
  for (std::size_t i = 0; i < NormalLanes::kDeviates; i += kWidth)
    normal_deviate<Real>(uniform_positive_of<Real>(Bits::load(radius + i)),
                         uniform_of<Real>(Bits::load(turn + i)))
        .store(lanes.deviates + i);
}

}  // namespace
}  // namespace scintray::core
