#pragma once
/// The photons of the pool (lane_pool.hpp) that are in the lanes of one vector, and their random numbers.

#include "scintray/core/lanes/lane_fours.hpp"
#include "scintray/core/philox_laws.hpp"
#include "scintray/transport/detail/lanes/lane_pool.hpp"

namespace scintray::transport {

namespace {

using core::LaneFours;

/// Method of drawing random numbers: a block in each lane, or with scalar instructions only for lanes that
/// lack numbers, which is faster where vectors are short, as their products have 32 bits.
enum class LaneDraws { in_lanes, one_by_one };

template <typename Real, LaneDraws kDraws>
class LanePhotons {
 protected:
  using Mask = typename Real::Mask;
  using Bits = typename Real::Bits;
  using Vector = core::Triple<Real>;
  static constexpr std::size_t kWidth = Real::kWidth;
  static_assert(LanePool::kPhotons % kWidth == 0);

  explicit LanePhotons(LanePool& pool) : pool_(pool) {}

  Real load(const LanePool::Numbers& numbers) const { return Real::load(numbers + at_); }
  Vector load(const LanePool::Numbers (&numbers)[3]) const {
    return {load(numbers[0]), load(numbers[1]), load(numbers[2])};
  }
  Bits load(const LanePool::Counts& counts) const { return Bits::load(counts + at_); }
  void store(LanePool::Numbers& to, const Real& value) const { value.store(to + at_); }
  void store(LanePool::Numbers (&to)[3], const Vector& value) const {
    store(to[0], value.x), store(to[1], value.y), store(to[2], value.z);
  }
  void store(LanePool::Counts& to, const Bits& value) const { value.store(to + at_); }

  static Real one_if(const Mask& condition) { return select(condition, Real(1.0), Real(0.0)); }
  static Bits choose(const Mask& condition, const Bits& yes, const Bits& no) {
    return bits_of(select(condition, number_of(yes), number_of(no)));
  }

  /// Draws a block of random numbers for each photon of `draws` with fewer than `needed`, at most four, left.
  void draw(const Mask& draws, double needed) {
    const Real ready = value_of((load(pool_.counter[0]) << 2) - load(pool_.drawn));
    const Mask lack = draws & (ready < Real(needed));
    if (!any(lack)) return;
    if constexpr (kDraws == LaneDraws::in_lanes)
      draw_in_lanes(ready <= Real(static_cast<double>(LanePool::kNumbers - 4)));
    else
      draw_one_by_one(lanes_of(lack));
  }
  /// Four random numbers of each photon.
  struct Random {
    Bits bits[4];
    Real uniform(int i) const { return core::uniform_of<Real>(bits[i]); }
    Real uniform_positive(int i) const { return core::uniform_positive_of<Real>(bits[i]); }
  };
  /// The next ones, not yet counted as drawn.
  Random next_numbers() const {
    LaneFours<Real> fours;
    load_fours(next_places().at, fours);
    return {{bits_of(fours.of[0]), bits_of(fours.of[1]), bits_of(fours.of[2]), bits_of(fours.of[3])}};
  }
  /// The next one, likewise.
  Bits next_number() const {
    Real ones;
    load_ones(next_places().at, ones);
    return bits_of(ones);
  }
  /// Counts numbers as drawn, whole ones from 0 to 7.
  void count_drawn(const Real& numbers) { store(pool_.drawn, load(pool_.drawn) + whole(numbers)); }

  LanePool& pool_;
  std::size_t at_ = 0;  ///< the first photon of the vector

 private:
  struct Places {
    const double* at[kWidth];
  };
  /// Where the next random number of each photon is.
  Places next_places() const {
    Places places;
    for (std::size_t lane = 0; lane < kWidth; ++lane)
      places.at[lane] = reinterpret_cast<const double*>(pool_.numbers[at_ + lane]) +
                        pool_.drawn[at_ + lane] % LanePool::kNumbers;
    return places;
  }
  /// A whole number from 0 to 7 as bits.
  static Bits whole(const Real& number) { return bits_of(number + Real(0x1.0p52)) & Bits(7); }

  /// @param lanes  a bit for each
  void draw_one_by_one(unsigned lanes) {
    for (; lanes != 0; lanes &= lanes - 1) {
      const std::size_t slot = at_ + static_cast<std::size_t>(__builtin_ctz(lanes));
      const std::uint64_t number = pool_.counter[0][slot]++;
      const core::PhiloxBlock<std::uint64_t> block(
          {number, pool_.counter[1][slot], pool_.counter[2][slot], pool_.counter[3][slot]},
          {pool_.key[0][slot], pool_.key[1][slot]});
      std::uint64_t* const numbers = pool_.numbers[slot];
      const std::size_t first = number * 4 % LanePool::kNumbers;
      for (std::size_t i = 0; i < 4; ++i) numbers[first + i] = block.words[i];
      if (first > 0) continue;
      for (std::size_t i = 0; i < 4; ++i) numbers[LanePool::kNumbers + i] = block.words[i];
    }
  }
  /// For all photons with room, also those that do not lack numbers.
  void draw_in_lanes(const Mask& room) {
    const Bits blocks = load(pool_.counter[0]);
    const core::PhiloxBlock<Bits> block(
        {blocks, load(pool_.counter[1]), load(pool_.counter[2]), load(pool_.counter[3])},
        {load(pool_.key[0]), load(pool_.key[1])});
    store(pool_.counter[0], blocks + whole(one_if(room)));
    alignas(64) std::uint64_t number[kWidth];
    blocks.store(number);
    const unsigned lanes = lanes_of(room);
    std::uint64_t *first[kWidth], *second[kWidth], nowhere[4];
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
      std::uint64_t* const numbers = pool_.numbers[at_ + lane];
      const std::size_t at = number[lane] * 4 % LanePool::kNumbers;
      const bool takes = (lanes >> lane & 1) != 0;
      first[lane] = takes ? numbers + at : nowhere;
      second[lane] = takes && at == 0 ? numbers + LanePool::kNumbers : nowhere;
    }
    store_fours(block.words, first, second);
  }
};

}  // namespace
}  // namespace scintray::transport
