#pragma once
/// Numbers in the lanes of a vector register, or of two, with the operations of core/number.hpp. Each
/// instruction set has its own type, so that code compiled for one cannot replace that for another.

#include <cstddef>
#include <xsimd/xsimd.hpp>

#include "scintray/core/number.hpp"

namespace scintray::core {

template <typename Arch>
struct LaneReal;
template <typename Arch>
struct LaneBits;

/// A bit for each lane in which a comparison holds, that of the first lane first.
static inline unsigned bits_of_lanes(__m128d lanes) { return static_cast<unsigned>(_mm_movemask_pd(lanes)); }
#ifdef __AVX2__
static inline unsigned bits_of_lanes(__m256d lanes) {
  return static_cast<unsigned>(_mm256_movemask_pd(lanes));
}
#endif
#ifdef __AVX512F__
static inline unsigned bits_of_lanes(__mmask8 lanes) { return lanes; }
#endif

// The reverse.
static inline void set_lanes(unsigned bits, __m128d& lanes) {
  const __m128i each = _mm_set_epi64x(2, 1), common = _mm_and_si128(_mm_set1_epi64x(bits), each);
  const __m128i equal = _mm_cmpeq_epi32(common, each);  // of both halves; the upper ones are 0 in both
  lanes = _mm_castsi128_pd(_mm_and_si128(equal, _mm_shuffle_epi32(equal, _MM_SHUFFLE(2, 3, 0, 1))));
}
#ifdef __AVX2__
static inline void set_lanes(unsigned bits, __m256d& lanes) {
  const __m256i each = _mm256_set_epi64x(8, 4, 2, 1);
  lanes = _mm256_castsi256_pd(_mm256_cmpeq_epi64(_mm256_and_si256(_mm256_set1_epi64x(bits), each), each));
}
#endif
#ifdef __AVX512F__
static inline void set_lanes(unsigned bits, __mmask8& lanes) { lanes = static_cast<__mmask8>(bits); }
#endif

// Numbers where a comparison holds, and 0 in other lanes: one instruction, where a selection takes AVX2
// three.
static inline __m128d kept_lanes(__m128d lanes, __m128d x) { return _mm_and_pd(lanes, x); }
#ifdef __AVX2__
static inline __m256d kept_lanes(__m256d lanes, __m256d x) { return _mm256_and_pd(lanes, x); }
#endif
#ifdef __AVX512F__
static inline __m512d kept_lanes(__mmask8 lanes, __m512d x) { return _mm512_maskz_mov_pd(lanes, x); }
#endif

// The opposite of a comparison. xsimd 8.1 takes an AVX register apart for it.
static inline __m128d other_lanes(__m128d lanes) {
  return _mm_xor_pd(lanes, _mm_castsi128_pd(_mm_set1_epi64x(-1)));
}
#ifdef __AVX2__
static inline __m256d other_lanes(__m256d lanes) {
  return _mm256_xor_pd(lanes, _mm256_castsi256_pd(_mm256_set1_epi64x(-1)));
}
#endif
#ifdef __AVX512F__
static inline __mmask8 other_lanes(__mmask8 lanes) { return static_cast<__mmask8>(~lanes); }
#endif

// `negative` where the sign bit of x is set, else `positive`. By an instruction of its own, since GCC 12
// compares what it selects by with 0 before.
static inline __m128d chosen_by_sign(__m128d x, __m128d positive, __m128d negative) {
  const __m128d lanes =
      _mm_castsi128_pd(_mm_shuffle_epi32(_mm_srai_epi32(_mm_castpd_si128(x), 31), _MM_SHUFFLE(3, 3, 1, 1)));
  return _mm_or_pd(_mm_and_pd(lanes, negative), _mm_andnot_pd(lanes, positive));
}
#ifdef __AVX2__
static inline __m256d chosen_by_sign(__m256d x, __m256d positive, __m256d negative) {
  asm("vblendvpd %2, %1, %0, %0" : "+x"(positive) : "xm"(negative), "x"(x));
  return positive;
}
#endif
#ifdef __AVX512F__
static inline __m512d chosen_by_sign(__m512d x, __m512d positive, __m512d negative) {
  return _mm512_mask_blend_pd(_mm512_cmp_pd_mask(x, _mm512_setzero_pd(), _CMP_LT_OQ), positive, negative);
}
#endif

// As core::whole_part.
static inline __m128d whole_parts(__m128d x) { return _mm_cvtepi32_pd(_mm_cvttpd_epi32(x)); }
#ifdef __AVX2__
static inline __m256d whole_parts(__m256d x) {
  return _mm256_round_pd(x, _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC);
}
#endif
#ifdef __AVX512F__
static inline __m512d whole_parts(__m512d x) {
  return _mm512_roundscale_pd(x, _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC);
}
#endif

// What a comparison selects.
static inline __m128d selected_lanes(__m128d lanes, __m128d yes, __m128d no) {
  return _mm_or_pd(_mm_and_pd(lanes, yes), _mm_andnot_pd(lanes, no));
}
#ifdef __AVX2__
static inline __m256d selected_lanes(__m256d lanes, __m256d yes, __m256d no) {
  return chosen_by_sign(lanes, no, yes);
}
#endif
#ifdef __AVX512F__
static inline __m512d selected_lanes(__mmask8 lanes, __m512d yes, __m512d no) {
  return _mm512_mask_blend_pd(lanes, no, yes);
}
#endif

/// The results of a comparison in each lane.
template <typename Arch>
struct LaneMask {
  xsimd::batch_bool<double, Arch> lanes;

  /// @param bits  as of lanes_of()
  static LaneMask of(unsigned bits) {
    typename xsimd::batch_bool<double, Arch>::register_type lanes;
    set_lanes(bits, lanes);
    return {lanes};
  }

  friend LaneMask operator&(const LaneMask& a, const LaneMask& b) { return {a.lanes & b.lanes}; }
  friend LaneMask operator|(const LaneMask& a, const LaneMask& b) { return {a.lanes | b.lanes}; }
  friend LaneMask operator!(const LaneMask& a) { return {other_lanes(a.lanes)}; }
  friend bool any(const LaneMask& a) { return xsimd::any(a.lanes); }
  friend unsigned lanes_of(const LaneMask& a) { return bits_of_lanes(a.lanes); }
  friend bool all(const LaneMask& a) { return xsimd::all(a.lanes); }
};

// As core::rotated.
template <int kCount>
static inline __m128i rotated_lanes(__m128i bits) {
  return _mm_or_si128(_mm_slli_epi64(bits, kCount), _mm_srli_epi64(bits, 64 - kCount));
}
#ifdef __AVX2__
template <int kCount>
static inline __m256i rotated_lanes(__m256i bits) {
  return _mm256_or_si256(_mm256_slli_epi64(bits, kCount), _mm256_srli_epi64(bits, 64 - kCount));
}
#endif
#ifdef __AVX512F__
template <int kCount>
static inline __m512i rotated_lanes(__m512i bits) {
  return _mm512_rol_epi64(bits, kCount);
}
#endif

/// 64 bits in each lane.
template <typename Arch>
struct LaneBits {
  using Lanes = xsimd::batch<std::uint64_t, Arch>;
  static constexpr std::size_t kWidth = Lanes::size;
  Lanes lanes;

  LaneBits() = default;
  explicit LaneBits(std::uint64_t all) : lanes(all) {}
  LaneBits(const Lanes& of) : lanes(of) {}  // NOLINT(google-explicit-constructor)

  static LaneBits load(const std::uint64_t* from) { return Lanes::load_aligned(from); }
  void store(std::uint64_t* to) const { lanes.store_aligned(to); }

  friend LaneBits operator+(const LaneBits& a, const LaneBits& b) { return a.lanes + b.lanes; }
  friend LaneBits operator-(const LaneBits& a, const LaneBits& b) { return a.lanes - b.lanes; }
  friend LaneBits operator&(const LaneBits& a, const LaneBits& b) { return a.lanes & b.lanes; }
  friend LaneBits operator|(const LaneBits& a, const LaneBits& b) { return a.lanes | b.lanes; }
  friend LaneBits operator^(const LaneBits& a, const LaneBits& b) { return a.lanes ^ b.lanes; }
  friend LaneBits operator<<(const LaneBits& a, int count) { return a.lanes << count; }
  friend LaneBits operator>>(const LaneBits& a, int count) { return a.lanes >> count; }
  friend LaneReal<Arch> number_of(const LaneBits& bits) {
    return {xsimd::bitwise_cast<xsimd::batch<double, Arch>>(bits.lanes)};
  }
};

template <int kCount, typename Arch>
LaneBits<Arch> rotated(const LaneBits<Arch>& bits) {
  return typename LaneBits<Arch>::Lanes(rotated_lanes<kCount>(bits.lanes));
}

/// A double in each lane.
template <typename Arch>
struct LaneReal {
  using Mask = LaneMask<Arch>;
  using Bits = LaneBits<Arch>;
  using Lanes = xsimd::batch<double, Arch>;
  static constexpr std::size_t kWidth = Lanes::size;
  Lanes lanes;

  LaneReal() = default;
  explicit LaneReal(double all) : lanes(all) {}
  LaneReal(const Lanes& of) : lanes(of) {}  // NOLINT(google-explicit-constructor)

  static LaneReal load(const double* from) { return Lanes::load_aligned(from); }
  void store(double* to) const { lanes.store_aligned(to); }

  friend LaneReal operator+(const LaneReal& a, const LaneReal& b) { return a.lanes + b.lanes; }
  friend LaneReal operator-(const LaneReal& a, const LaneReal& b) { return a.lanes - b.lanes; }
  friend LaneReal operator*(const LaneReal& a, const LaneReal& b) { return a.lanes * b.lanes; }
  friend LaneReal operator/(const LaneReal& a, const LaneReal& b) { return a.lanes / b.lanes; }
  friend LaneReal operator-(const LaneReal& a) { return number_of(bits_of(a) ^ Bits(kSign)); }
  friend Mask operator<(const LaneReal& a, const LaneReal& b) { return {a.lanes < b.lanes}; }
  friend Mask operator>(const LaneReal& a, const LaneReal& b) { return {a.lanes > b.lanes}; }
  friend Mask operator<=(const LaneReal& a, const LaneReal& b) { return {a.lanes <= b.lanes}; }
  friend Mask operator>=(const LaneReal& a, const LaneReal& b) { return {a.lanes >= b.lanes}; }
  friend Mask operator==(const LaneReal& a, const LaneReal& b) { return {a.lanes == b.lanes}; }
  friend LaneReal select(const Mask& condition, const LaneReal& yes, const LaneReal& no) {
    return Lanes(selected_lanes(condition.lanes, yes.lanes, no.lanes));
  }
  /// x where the condition holds, else 0.
  friend LaneReal where(const Mask& condition, const LaneReal& x) {
    return Lanes(kept_lanes(condition.lanes, x.lanes));
  }
  /// As core::least and core::greatest, which their instructions are.
  friend LaneReal least(const LaneReal& a, const LaneReal& b) { return xsimd::min(a.lanes, b.lanes); }
  friend LaneReal greatest(const LaneReal& a, const LaneReal& b) { return xsimd::max(a.lanes, b.lanes); }
  friend LaneReal select_by_sign(const LaneReal& x, const LaneReal& positive, const LaneReal& negative) {
    return Lanes(chosen_by_sign(x.lanes, positive.lanes, negative.lanes));
  }
  friend Bits bits_of(const LaneReal& x) { return xsimd::bitwise_cast<typename Bits::Lanes>(x.lanes); }
  friend LaneReal whole_part(const LaneReal& x) { return Lanes(whole_parts(x.lanes)); }
  friend LaneReal root(const LaneReal& x) { return xsimd::sqrt(x.lanes); }
  friend LaneReal magnitude(const LaneReal& x) { return number_of(bits_of(x) & Bits(~kSign)); }

 private:
  static constexpr std::uint64_t kSign = std::uint64_t{1} << 63;
};

// Two registers: each operation is made twice, on independent numbers, so that a processor executes one while
// it waits for the other. Decisions common to all lanes are made half as often.

template <typename Arch>
struct LaneRealPair;

/// The results of a comparison in each lane.
template <typename Arch>
struct LaneMaskPair {
  LaneMask<Arch> a, b;

  /// @param bits  as of lanes_of()
  static LaneMaskPair of(unsigned bits) {
    return {LaneMask<Arch>::of(bits), LaneMask<Arch>::of(bits >> LaneReal<Arch>::kWidth)};
  }

  friend LaneMaskPair operator&(const LaneMaskPair& x, const LaneMaskPair& y) {
    return {x.a & y.a, x.b & y.b};
  }
  friend LaneMaskPair operator|(const LaneMaskPair& x, const LaneMaskPair& y) {
    return {x.a | y.a, x.b | y.b};
  }
  friend LaneMaskPair operator!(const LaneMaskPair& x) { return {!x.a, !x.b}; }
  friend bool any(const LaneMaskPair& x) { return any(x.a | x.b); }
  friend bool all(const LaneMaskPair& x) { return all(x.a & x.b); }
  /// A bit for each lane.
  friend unsigned lanes_of(const LaneMaskPair& x) {
    return lanes_of(x.a) | (lanes_of(x.b) << LaneReal<Arch>::kWidth);
  }
};

/// 64 bits in each lane.
template <typename Arch>
struct LaneBitsPair {
  using One = LaneBits<Arch>;
  One a, b;

  LaneBitsPair() = default;
  explicit LaneBitsPair(std::uint64_t all) : a(all), b(all) {}
  LaneBitsPair(const One& first, const One& second) : a(first), b(second) {}

  static LaneBitsPair load(const std::uint64_t* from) {
    return {One::load(from), One::load(from + One::kWidth)};
  }
  void store(std::uint64_t* to) const { a.store(to), b.store(to + One::kWidth); }
  friend LaneBitsPair operator+(const LaneBitsPair& x, const LaneBitsPair& y) {
    return {x.a + y.a, x.b + y.b};
  }
  friend LaneBitsPair operator-(const LaneBitsPair& x, const LaneBitsPair& y) {
    return {x.a - y.a, x.b - y.b};
  }
  friend LaneBitsPair operator&(const LaneBitsPair& x, const LaneBitsPair& y) {
    return {x.a & y.a, x.b & y.b};
  }
  friend LaneBitsPair operator|(const LaneBitsPair& x, const LaneBitsPair& y) {
    return {x.a | y.a, x.b | y.b};
  }
  friend LaneBitsPair operator^(const LaneBitsPair& x, const LaneBitsPair& y) {
    return {x.a ^ y.a, x.b ^ y.b};
  }
  friend LaneBitsPair operator<<(const LaneBitsPair& x, int count) { return {x.a << count, x.b << count}; }
  friend LaneBitsPair operator>>(const LaneBitsPair& x, int count) { return {x.a >> count, x.b >> count}; }
  friend LaneRealPair<Arch> number_of(const LaneBitsPair& x) { return {number_of(x.a), number_of(x.b)}; }
};

template <int kCount, typename Arch>
LaneBitsPair<Arch> rotated(const LaneBitsPair<Arch>& x) {
  return {rotated<kCount>(x.a), rotated<kCount>(x.b)};
}

/// A double in each lane.
template <typename Arch>
struct LaneRealPair {
  using One = LaneReal<Arch>;
  using Mask = LaneMaskPair<Arch>;
  using Bits = LaneBitsPair<Arch>;
  static constexpr std::size_t kWidth = 2 * One::kWidth;
  One a, b;

  LaneRealPair() = default;
  explicit LaneRealPair(double all) : a(all), b(all) {}
  LaneRealPair(const One& first, const One& second) : a(first), b(second) {}

  static LaneRealPair load(const double* from) { return {One::load(from), One::load(from + One::kWidth)}; }
  void store(double* to) const { a.store(to), b.store(to + One::kWidth); }
  friend LaneRealPair operator+(const LaneRealPair& x, const LaneRealPair& y) {
    return {x.a + y.a, x.b + y.b};
  }
  friend LaneRealPair operator-(const LaneRealPair& x, const LaneRealPair& y) {
    return {x.a - y.a, x.b - y.b};
  }
  friend LaneRealPair operator*(const LaneRealPair& x, const LaneRealPair& y) {
    return {x.a * y.a, x.b * y.b};
  }
  friend LaneRealPair operator/(const LaneRealPair& x, const LaneRealPair& y) {
    return {x.a / y.a, x.b / y.b};
  }
  friend LaneRealPair operator-(const LaneRealPair& x) { return {-x.a, -x.b}; }
  friend Mask operator<(const LaneRealPair& x, const LaneRealPair& y) { return {x.a < y.a, x.b < y.b}; }
  friend Mask operator>(const LaneRealPair& x, const LaneRealPair& y) { return {x.a > y.a, x.b > y.b}; }
  friend Mask operator<=(const LaneRealPair& x, const LaneRealPair& y) { return {x.a <= y.a, x.b <= y.b}; }
  friend Mask operator>=(const LaneRealPair& x, const LaneRealPair& y) { return {x.a >= y.a, x.b >= y.b}; }
  friend Mask operator==(const LaneRealPair& x, const LaneRealPair& y) { return {x.a == y.a, x.b == y.b}; }
  friend LaneRealPair select(const Mask& condition, const LaneRealPair& yes, const LaneRealPair& no) {
    return {select(condition.a, yes.a, no.a), select(condition.b, yes.b, no.b)};
  }
  friend LaneRealPair where(const Mask& condition, const LaneRealPair& x) {
    return {where(condition.a, x.a), where(condition.b, x.b)};
  }
  friend LaneRealPair least(const LaneRealPair& x, const LaneRealPair& y) {
    return {least(x.a, y.a), least(x.b, y.b)};
  }
  friend LaneRealPair greatest(const LaneRealPair& x, const LaneRealPair& y) {
    return {greatest(x.a, y.a), greatest(x.b, y.b)};
  }
  friend LaneRealPair select_by_sign(const LaneRealPair& x, const LaneRealPair& positive,
                                     const LaneRealPair& negative) {
    return {select_by_sign(x.a, positive.a, negative.a), select_by_sign(x.b, positive.b, negative.b)};
  }
  friend Bits bits_of(const LaneRealPair& x) { return {bits_of(x.a), bits_of(x.b)}; }
  friend LaneRealPair whole_part(const LaneRealPair& x) { return {whole_part(x.a), whole_part(x.b)}; }
  friend LaneRealPair root(const LaneRealPair& x) { return {root(x.a), root(x.b)}; }
  friend LaneRealPair magnitude(const LaneRealPair& x) { return {magnitude(x.a), magnitude(x.b)}; }
};

}  // namespace scintray::core
