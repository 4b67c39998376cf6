#pragma once
/// The photons of the pool (lane_pool.hpp) that are in the lanes of one vector, and their random numbers.

#include "scintray/core/philox_laws.hpp"
#include "scintray/transport/detail/lanes/lane_number.hpp"
#include "scintray/transport/detail/lanes/lane_pool.hpp"

namespace scintray::transport {

// Loads and stores of four numbers that follow each other in memory, at a place of its own for each lane.

/// Four numbers of each lane.
template <typename Real>
struct LaneFours {
  Real of[4];
};

/// Stores four 64-bit numbers of each lane at two places of its own.
static inline void store_fours(const LaneBits<xsimd::sse2>* words, std::uint64_t* const* first,
                               std::uint64_t* const* second) {
  for (int half = 0; half < 2; ++half) {
    const __m128i a = words[2 * half].lanes, b = words[2 * half + 1].lanes;
    const __m128i lanes[2] = {_mm_unpacklo_epi64(a, b), _mm_unpackhi_epi64(a, b)};
    for (int lane = 0; lane < 2; ++lane) {
      _mm_storeu_si128(reinterpret_cast<__m128i*>(first[lane] + 2 * half), lanes[lane]);
      _mm_storeu_si128(reinterpret_cast<__m128i*>(second[lane] + 2 * half), lanes[lane]);
    }
  }
}

static inline void load_fours(const double* const* at, LaneFours<LaneReal<xsimd::sse2>>& to) {
  for (int half = 0; half < 2; ++half) {
    const __m128d a = _mm_loadu_pd(at[0] + 2 * half), b = _mm_loadu_pd(at[1] + 2 * half);
    to.of[2 * half].lanes = _mm_unpacklo_pd(a, b);
    to.of[2 * half + 1].lanes = _mm_unpackhi_pd(a, b);
  }
}

#ifdef __AVX2__
static inline void store_four(__m256i four, std::uint64_t* first, std::uint64_t* second) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(first), four);
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(second), four);
}
static inline void store_fours(const LaneBits<xsimd::avx2>* words, std::uint64_t* const* first,
                               std::uint64_t* const* second) {
  const __m256i a = words[0].lanes, b = words[1].lanes, c = words[2].lanes, d = words[3].lanes;
  const __m256i ab = _mm256_unpacklo_epi64(a, b), ba = _mm256_unpackhi_epi64(a, b);
  const __m256i cd = _mm256_unpacklo_epi64(c, d), dc = _mm256_unpackhi_epi64(c, d);
  store_four(_mm256_permute2x128_si256(ab, cd, 0x20), first[0], second[0]);
  store_four(_mm256_permute2x128_si256(ba, dc, 0x20), first[1], second[1]);
  store_four(_mm256_permute2x128_si256(ab, cd, 0x31), first[2], second[2]);
  store_four(_mm256_permute2x128_si256(ba, dc, 0x31), first[3], second[3]);
}
static inline void load_fours(const double* const* at, LaneFours<LaneReal<xsimd::avx2>>& to) {
  const __m256d a = _mm256_loadu_pd(at[0]), b = _mm256_loadu_pd(at[1]);
  const __m256d c = _mm256_loadu_pd(at[2]), d = _mm256_loadu_pd(at[3]);
  const __m256d ab = _mm256_unpacklo_pd(a, b), ba = _mm256_unpackhi_pd(a, b);
  const __m256d cd = _mm256_unpacklo_pd(c, d), dc = _mm256_unpackhi_pd(c, d);
  to.of[0].lanes = _mm256_permute2f128_pd(ab, cd, 0x20);
  to.of[1].lanes = _mm256_permute2f128_pd(ba, dc, 0x20);
  to.of[2].lanes = _mm256_permute2f128_pd(ab, cd, 0x31);
  to.of[3].lanes = _mm256_permute2f128_pd(ba, dc, 0x31);
}
#endif

#ifdef __AVX512F__
static inline void store_fours(const LaneBits<xsimd::avx512f>* words, std::uint64_t* const* first,
                               std::uint64_t* const* second) {
  const __m512i a = words[0].lanes, b = words[1].lanes, c = words[2].lanes, d = words[3].lanes;
  const __m512i ab = _mm512_unpacklo_epi64(a, b), ba = _mm512_unpackhi_epi64(a, b);
  const __m512i cd = _mm512_unpacklo_epi64(c, d), dc = _mm512_unpackhi_epi64(c, d);
  // Quarter k of ab and cd has the numbers of lane 2 k, of ba and dc those of lane 2 k + 1.
  const auto store = [&](__m512i low, __m512i high, int even) {
    const __m512i front = _mm512_shuffle_i64x2(low, high, _MM_SHUFFLE(2, 0, 2, 0));
    const __m512i back = _mm512_shuffle_i64x2(low, high, _MM_SHUFFLE(3, 1, 3, 1));
    const __m512i fronts = _mm512_shuffle_i64x2(front, front, _MM_SHUFFLE(3, 1, 2, 0));
    const __m512i backs = _mm512_shuffle_i64x2(back, back, _MM_SHUFFLE(3, 1, 2, 0));
    store_four(_mm512_castsi512_si256(fronts), first[even], second[even]);
    store_four(_mm512_extracti64x4_epi64(fronts, 1), first[even + 4], second[even + 4]);
    store_four(_mm512_castsi512_si256(backs), first[even + 2], second[even + 2]);
    store_four(_mm512_extracti64x4_epi64(backs, 1), first[even + 6], second[even + 6]);
  };
  store(ab, cd, 0);
  store(ba, dc, 1);
}
static inline void load_fours(const double* const* at, LaneFours<LaneReal<xsimd::avx512f>>& to) {
  const auto two = [&](int lane) {
    return _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_loadu_pd(at[lane])),
                              _mm256_loadu_pd(at[lane + 2]), 1);
  };
  const __m512d a = two(0), b = two(1), c = two(4), d = two(5);
  const __m512d ab = _mm512_unpacklo_pd(a, b), ba = _mm512_unpackhi_pd(a, b);
  const __m512d cd = _mm512_unpacklo_pd(c, d), dc = _mm512_unpackhi_pd(c, d);
  to.of[0].lanes = _mm512_shuffle_f64x2(ab, cd, _MM_SHUFFLE(2, 0, 2, 0));
  to.of[1].lanes = _mm512_shuffle_f64x2(ba, dc, _MM_SHUFFLE(2, 0, 2, 0));
  to.of[2].lanes = _mm512_shuffle_f64x2(ab, cd, _MM_SHUFFLE(3, 1, 3, 1));
  to.of[3].lanes = _mm512_shuffle_f64x2(ba, dc, _MM_SHUFFLE(3, 1, 3, 1));
}
#endif

template <typename Arch>
void store_fours(const LaneBitsPair<Arch>* words, std::uint64_t* const* first, std::uint64_t* const* second) {
  constexpr std::size_t kHalf = LaneBits<Arch>::kWidth;
  const LaneBits<Arch> a[] = {words[0].a, words[1].a, words[2].a, words[3].a};
  const LaneBits<Arch> b[] = {words[0].b, words[1].b, words[2].b, words[3].b};
  store_fours(a, first, second);
  store_fours(b, first + kHalf, second + kHalf);
}
template <typename Arch>
void load_fours(const double* const* at, LaneFours<LaneRealPair<Arch>>& to) {
  LaneFours<LaneReal<Arch>> a, b;
  load_fours(at, a);
  load_fours(at + LaneReal<Arch>::kWidth, b);
  for (int i = 0; i < 4; ++i) to.of[i] = {a.of[i], b.of[i]};
}

namespace {

/// Which way random numbers are drawn: a block in each lane, or with scalar instructions for those lanes
/// alone that lack numbers, which is faster where vectors are short, as their products are of 32 bits.
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

  /// A block of random numbers for each photon of `draws` that has fewer than so many, at most four, left.
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
    const double* first[kWidth];
    for (std::size_t lane = 0; lane < kWidth; ++lane)
      first[lane] = reinterpret_cast<const double*>(pool_.numbers[at_ + lane]) +
                    pool_.drawn[at_ + lane] % LanePool::kNumbers;
    LaneFours<Real> fours;
    load_fours(first, fours);
    return {{bits_of(fours.of[0]), bits_of(fours.of[1]), bits_of(fours.of[2]), bits_of(fours.of[3])}};
  }
  /// The next one, likewise.
  Bits next_number() const {
    alignas(64) std::uint64_t of[kWidth];
    for (std::size_t lane = 0; lane < kWidth; ++lane)
      of[lane] = pool_.numbers[at_ + lane][pool_.drawn[at_ + lane] % LanePool::kNumbers];
    return Bits::load(of);
  }
  /// Counts numbers as drawn, whole ones from 0 to 7.
  void count_drawn(const Real& numbers) { store(pool_.drawn, load(pool_.drawn) + whole(numbers)); }

  LanePool& pool_;
  std::size_t at_ = 0;  ///< the first photon of the vector

 private:
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
  /// For all that have room: which are computed does not depend on who lacks numbers.
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
