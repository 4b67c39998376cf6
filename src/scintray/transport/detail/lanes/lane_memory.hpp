#pragma once
/// Loads of four numbers that follow each other in memory, at a place of its own for each lane.

#include "scintray/transport/detail/lanes/lane_number.hpp"

namespace scintray::transport {

/// Four numbers of each lane.
template <typename Arch>
struct LaneFours {
  LaneReal<Arch> of[4];
};

static inline void load_fours(const double* const* at, LaneFours<xsimd::sse2>& to) {
  for (int half = 0; half < 2; ++half) {
    const __m128d a = _mm_loadu_pd(at[0] + 2 * half), b = _mm_loadu_pd(at[1] + 2 * half);
    to.of[2 * half].lanes = _mm_unpacklo_pd(a, b);
    to.of[2 * half + 1].lanes = _mm_unpackhi_pd(a, b);
  }
}

#ifdef __AVX2__
static inline void load_fours(const double* const* at, LaneFours<xsimd::avx2>& to) {
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
static inline void load_fours(const double* const* at, LaneFours<xsimd::avx512f>& to) {
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

}  // namespace scintray::transport
