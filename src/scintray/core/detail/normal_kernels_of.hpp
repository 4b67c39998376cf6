#pragma once
/// The kernel of normal_kernels.hpp for one instruction set. Included by one file for each.

#include "scintray/core/detail/normal_kernels.hpp"
#include "scintray/core/elementary_laws.hpp"
#include "scintray/core/lanes/lane_fours.hpp"
#include "scintray/core/philox_laws.hpp"
#include "scintray/core/sampling_laws.hpp"

namespace scintray::core {
namespace {

/// Draws the blocks of numbers.
template <typename Bits>
[[gnu::always_inline]] inline void draw_blocks(NormalLanes& lanes, const PhiloxKeys<std::uint64_t>& keys) {
  constexpr std::size_t kWidth = Bits::kWidth;
  static_assert(NormalLanes::kBlocks % kWidth == 0);
  alignas(64) std::uint64_t steps[kWidth];
  for (std::size_t lane = 0; lane < kWidth; ++lane) steps[lane] = lane;
  const Bits step = Bits::load(steps);
  for (std::size_t first = 0; first < NormalLanes::kBlocks; first += kWidth) {
    const PhiloxBlock<Bits> block({Bits(lanes.counter[0] + first) + step, Bits(lanes.counter[1]),
                                   Bits(lanes.counter[2]), Bits(lanes.counter[3])},
                                  keys);
    std::uint64_t* to[kWidth];
    for (std::size_t lane = 0; lane < kWidth; ++lane)
      to[lane] = lanes.numbers + NormalLanes::kLeft + 4 * (first + lane);
    store_fours(block.words, to, to);
  }
}

/// Likewise, one block after the other.
[[gnu::always_inline]] inline void draw_blocks_one_by_one(NormalLanes& lanes,
                                                          const PhiloxKeys<std::uint64_t>& keys) {
  for (std::size_t number = 0; number < NormalLanes::kBlocks; ++number) {
    const PhiloxBlock<std::uint64_t> block(
        {lanes.counter[0] + number, lanes.counter[1], lanes.counter[2], lanes.counter[3]}, keys);
    for (std::size_t i = 0; i < 4; ++i) lanes.numbers[NormalLanes::kLeft + 4 * number + i] = block.words[i];
  }
}

template <typename Real, LaneDraws kDraws>
[[gnu::flatten, gnu::always_inline]] inline void draw_normals(NormalLanes& lanes) {
  using Bits = BitsOf<Real>;
  constexpr std::size_t kWidth = Real::kWidth;
  static_assert(NormalLanes::kPairs % kWidth == 0);
  const PhiloxKeys<std::uint64_t> keys(lanes.key[0], lanes.key[1]);
  if constexpr (kDraws == LaneDraws::one_by_one)
    draw_blocks_one_by_one(lanes, keys);
  else
    draw_blocks<Bits>(lanes, keys);
  const std::uint64_t* const numbers = lanes.numbers + NormalLanes::kLeft - lanes.left;
  alignas(64) std::uint64_t radius[NormalLanes::kPairs], turn[NormalLanes::kPairs];
  for (std::size_t i = 0; i < NormalLanes::kPairs; ++i) {
    radius[i] = numbers[2 * i];
    turn[i] = numbers[2 * i + 1];
  }
  for (std::size_t i = 0; i < NormalLanes::kPairs; i += kWidth) {
    const IndependentPair<Real> pairs = normal_deviates<Real>(
        uniform_positive_of<Real>(Bits::load(radius + i)), uniform_of<Real>(Bits::load(turn + i)));
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
