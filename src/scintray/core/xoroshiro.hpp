#pragma once
/// xoroshiro128++ over a type of 64-bit numbers (number.hpp): one sequence, or one in each lane.
///
/// Source: D. Blackman and S. Vigna 2021, "Scrambled Linear Pseudorandom Number Generators", ACM Trans. Math.
/// Softw. 47(4), 36; parameters 49, 21, 28 and 17 of the authors' program xoroshiro128plusplus.c.

#include "scintray/core/number.hpp"

namespace scintray::core {

/// State of a sequence of random numbers; not 0 in both words.
template <typename Bits>
struct Xoroshiro {
  Bits first, second;

  /// The next 64 random bits.
  [[gnu::always_inline]] Bits next() {
    const Bits random = rotated<17>(first + second) + first;
    const Bits mixed = first ^ second;
    first = rotated<49>(first) ^ mixed ^ (mixed << 21);
    second = rotated<28>(mixed);
    return random;
  }
};

template <typename Real>
Xoroshiro<BitsOf<Real>> select(const MaskOf<Real>& condition, const Xoroshiro<BitsOf<Real>>& yes,
                               const Xoroshiro<BitsOf<Real>>& no) {
  const auto word = [&](const BitsOf<Real>& a, const BitsOf<Real>& b) {
    return bits_of(select(condition, number_of(a), number_of(b)));
  };
  return {word(yes.first, no.first), word(yes.second, no.second)};
}

}  // namespace scintray::core
