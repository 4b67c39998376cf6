#pragma once
/// Loads and stores of four numbers that follow each other in memory, and loads of single ones, at a place of
/// its own for each lane.

#include <type_traits>

#include "scintray/core/lanes/lane_number.hpp"

namespace scintray::core {

/// Four numbers of each lane.
template <typename Real>
struct LaneFours {
  Real of[4];
};

/// Places at the same distance from the records of all lanes. As part of the address of a load, the distance
/// takes no instruction; pointers computed beforehand are added up in vectors and taken apart again. Always
/// inlined: its functions have one name for all instruction sets.
template <typename Record>
struct LanePlaces {
  Record* const* records;  ///< one of each lane
  std::size_t bytes;

  using Number = std::conditional_t<std::is_const_v<Record>, const double, double>;
  [[gnu::always_inline]] Number* operator[](std::size_t lane) const {
    using Byte = std::conditional_t<std::is_const_v<Record>, const char, char>;
    return reinterpret_cast<Number*>(reinterpret_cast<Byte*>(records[lane]) + bytes);
  }
  [[gnu::always_inline]] LanePlaces operator+(std::size_t lanes) const { return {records + lanes, bytes}; }
};

template <typename At>
void load_fours(const At& at, LaneFours<LaneReal<xsimd::sse2>>& to) {
  for (int half = 0; half < 2; ++half) {
    const __m128d a = _mm_loadu_pd(at[0] + 2 * half), b = _mm_loadu_pd(at[1] + 2 * half);
    to.of[2 * half].lanes = _mm_unpacklo_pd(a, b);
    to.of[2 * half + 1].lanes = _mm_unpackhi_pd(a, b);
  }
}

#ifdef __AVX2__
/// Four 64-bit numbers of each lane, as they are in memory: store(lane, four) receives those of one lane.
template <typename Store>
void store_by_lane(const LaneBits<xsimd::avx2>* words, const Store& store) {
  const __m256i a = words[0].lanes, b = words[1].lanes, c = words[2].lanes, d = words[3].lanes;
  const __m256i ab = _mm256_unpacklo_epi64(a, b), ba = _mm256_unpackhi_epi64(a, b);
  const __m256i cd = _mm256_unpacklo_epi64(c, d), dc = _mm256_unpackhi_epi64(c, d);
  store(0, _mm256_permute2x128_si256(ab, cd, 0x20));
  store(1, _mm256_permute2x128_si256(ba, dc, 0x20));
  store(2, _mm256_permute2x128_si256(ab, cd, 0x31));
  store(3, _mm256_permute2x128_si256(ba, dc, 0x31));
}
template <typename At>
void load_fours(const At& at, LaneFours<LaneReal<xsimd::avx2>>& to) {
  // Halves are joined as they are loaded, which leaves half of the exchanges between registers.
  const auto two = [&](std::size_t lane, int first) {
    return _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(at[lane] + first)),
                                _mm_loadu_pd(at[lane + 2] + first), 1);
  };
  for (int i = 0; i < 4; i += 2) {
    const __m256d a = two(0, i), b = two(1, i);
    to.of[i].lanes = _mm256_unpacklo_pd(a, b);
    to.of[i + 1].lanes = _mm256_unpackhi_pd(a, b);
  }
}
#endif

#ifdef __AVX512F__
template <typename Store>
void store_by_lane(const LaneBits<xsimd::avx512f>* words, const Store& store) {
  // The steps of load_fours() backwards.
  const __m512i low = _mm512_set_epi64(11, 10, 3, 2, 9, 8, 1, 0);
  const __m512i high = _mm512_set_epi64(15, 14, 7, 6, 13, 12, 5, 4);
  const __m512i ab = _mm512_permutex2var_epi64(words[0].lanes, low, words[2].lanes);
  const __m512i ba = _mm512_permutex2var_epi64(words[1].lanes, low, words[3].lanes);
  const __m512i cd = _mm512_permutex2var_epi64(words[0].lanes, high, words[2].lanes);
  const __m512i dc = _mm512_permutex2var_epi64(words[1].lanes, high, words[3].lanes);
  const auto two = [&](int lane, __m512i lanes) {
    store(lane, _mm512_castsi512_si256(lanes));
    store(lane + 2, _mm512_extracti64x4_epi64(lanes, 1));
  };
  two(0, _mm512_unpacklo_epi64(ab, ba));
  two(1, _mm512_unpackhi_epi64(ab, ba));
  two(4, _mm512_unpacklo_epi64(cd, dc));
  two(5, _mm512_unpackhi_epi64(cd, dc));
}
template <typename At>
void load_fours(const At& at, LaneFours<LaneReal<xsimd::avx512f>>& to) {
  const auto two = [&](std::size_t lane) {
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

#ifdef __AVX2__
template <typename Arch, typename Store>
void store_by_lane(const LaneBitsPair<Arch>* words, const Store& store) {
  constexpr int kHalf = static_cast<int>(LaneBits<Arch>::kWidth);
  const LaneBits<Arch> a[] = {words[0].a, words[1].a, words[2].a, words[3].a};
  const LaneBits<Arch> b[] = {words[0].b, words[1].b, words[2].b, words[3].b};
  store_by_lane(a, store);
  store_by_lane(b, [&](int lane, __m256i four) { store(lane + kHalf, four); });
}

/// Stores four numbers of each lane at places of these.
template <typename Real, typename Record>
void store_fours(const LaneFours<Real>& fours, const LanePlaces<Record>& to) {
  const typename Real::Bits words[] = {bits_of(fours.of[0]), bits_of(fours.of[1]), bits_of(fours.of[2]),
                                       bits_of(fours.of[3])};
  store_by_lane(words, [&](int lane, __m256i four) {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to[static_cast<std::size_t>(lane)]), four);
  });
}
#endif

template <typename Record>
void store_fours(const LaneFours<LaneReal<xsimd::sse2>>& fours, const LanePlaces<Record>& to) {
  for (int half = 0; half < 2; ++half) {
    const __m128d a = fours.of[2 * half].lanes, b = fours.of[2 * half + 1].lanes;
    _mm_storeu_pd(to[0] + 2 * half, _mm_unpacklo_pd(a, b));
    _mm_storeu_pd(to[1] + 2 * half, _mm_unpackhi_pd(a, b));
  }
}

/// Without a way through memory: the load of a vector waits for the stores of its parts.
static inline void load_ones(const double* const* at, LaneReal<xsimd::sse2>& to) {
  to.lanes = _mm_set_pd(*at[1], *at[0]);
}
#ifdef __AVX2__
static inline void load_ones(const double* const* at, LaneReal<xsimd::avx2>& to) {
  to.lanes = _mm256_set_pd(*at[3], *at[2], *at[1], *at[0]);
}
#endif
#ifdef __AVX512F__
static inline void load_ones(const double* const* at, LaneReal<xsimd::avx512f>& to) {
  to.lanes = _mm512_set_pd(*at[7], *at[6], *at[5], *at[4], *at[3], *at[2], *at[1], *at[0]);
}
#endif

/// Four short whole numbers, of 16 bits, that follow each other in memory.
static inline long long four_shorts(const std::uint16_t* at) {
  long long four;
  __builtin_memcpy(&four, at, sizeof four);
  return four;
}
// Of each lane.
#ifdef __AVX2__
static inline void load_four_shorts(const std::uint16_t* const* at, LaneBits<xsimd::avx2>& to) {
  to.lanes =
      _mm256_set_epi64x(four_shorts(at[3]), four_shorts(at[2]), four_shorts(at[1]), four_shorts(at[0]));
}
template <typename Arch>
void load_four_shorts(const std::uint16_t* const* at, LaneBitsPair<Arch>& to) {
  load_four_shorts(at, to.a);
  load_four_shorts(at + LaneBits<Arch>::kWidth, to.b);
}
#endif
#ifdef __AVX512F__
static inline void load_four_shorts(const std::uint16_t* const* at, LaneBits<xsimd::avx512f>& to) {
  to.lanes = _mm512_set_epi64(four_shorts(at[7]), four_shorts(at[6]), four_shorts(at[5]), four_shorts(at[4]),
                              four_shorts(at[3]), four_shorts(at[2]), four_shorts(at[1]), four_shorts(at[0]));
}
#endif

/// Four floats of each lane that follow each other in memory.
#ifdef __AVX2__
static inline void load_four_floats(const float* const* at, LaneFours<LaneReal<xsimd::avx2>>& to) {
  __m128 a = _mm_loadu_ps(at[0]), b = _mm_loadu_ps(at[1]), c = _mm_loadu_ps(at[2]), d = _mm_loadu_ps(at[3]);
  _MM_TRANSPOSE4_PS(a, b, c, d);
  to.of[0].lanes = _mm256_cvtps_pd(a), to.of[1].lanes = _mm256_cvtps_pd(b);
  to.of[2].lanes = _mm256_cvtps_pd(c), to.of[3].lanes = _mm256_cvtps_pd(d);
}
template <typename Arch>
void load_four_floats(const float* const* at, LaneFours<LaneRealPair<Arch>>& to) {
  LaneFours<LaneReal<Arch>> a, b;
  load_four_floats(at, a);
  load_four_floats(at + LaneReal<Arch>::kWidth, b);
  for (int i = 0; i < 4; ++i) to.of[i] = {a.of[i], b.of[i]};
}
#endif
#ifdef __AVX512F__
static inline void load_four_floats(const float* const* at, LaneFours<LaneReal<xsimd::avx512f>>& to) {
  const auto two = [&](int lane) {
    return _mm256_set_m128(_mm_loadu_ps(at[lane + 4]), _mm_loadu_ps(at[lane]));
  };
  const __m256 a = two(0), b = two(1), c = two(2), d = two(3);
  const __m256 ab = _mm256_unpacklo_ps(a, b), ba = _mm256_unpackhi_ps(a, b);
  const __m256 cd = _mm256_unpacklo_ps(c, d), dc = _mm256_unpackhi_ps(c, d);
  to.of[0].lanes = _mm512_cvtps_pd(_mm256_shuffle_ps(ab, cd, _MM_SHUFFLE(1, 0, 1, 0)));
  to.of[1].lanes = _mm512_cvtps_pd(_mm256_shuffle_ps(ab, cd, _MM_SHUFFLE(3, 2, 3, 2)));
  to.of[2].lanes = _mm512_cvtps_pd(_mm256_shuffle_ps(ba, dc, _MM_SHUFFLE(1, 0, 1, 0)));
  to.of[3].lanes = _mm512_cvtps_pd(_mm256_shuffle_ps(ba, dc, _MM_SHUFFLE(3, 2, 3, 2)));
}
#endif
template <typename Arch>
void load_ones(const double* const* at, LaneRealPair<Arch>& to) {
  load_ones(at, to.a);
  load_ones(at + LaneReal<Arch>::kWidth, to.b);
}
template <typename At, typename Arch>
void load_fours(const At& at, LaneFours<LaneRealPair<Arch>>& to) {
  LaneFours<LaneReal<Arch>> a, b;
  load_fours(at, a);
  load_fours(at + LaneReal<Arch>::kWidth, b);
  for (int i = 0; i < 4; ++i) to.of[i] = {a.of[i], b.of[i]};
}

}  // namespace scintray::core
