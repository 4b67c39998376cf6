#pragma once
/// Sums of floating numbers that do not depend on the order of the addends.

#include <array>
#include <cstdint>

namespace scintray::core {

/// The exact sum of any number of doubles, as a fixed-point number of 256 bits: each addend counts in whole
/// multiples of 2^-112 (1.9e-34), rounded towards zero, so that any double from 2^-60 (8.7e-19) on counts in
/// full. Sums of parts, merged in any order, are those of the whole to the last bit.
///
/// An addend that is not finite, or not below 2^100 (1.3e30), makes the sum not a number for ever. Below it
/// 2^43 addends cannot overflow.
class ExactSum {
 public:
  using Words = std::array<std::uint64_t, 4>;

  void add(double addend);
  void merge(const ExactSum& other);
  /// The sum, rounded to the nearest double (ties to even); not a number after an invalid addend.
  double value() const;

  /// Two's complement, the least significant word first, in units of 2^-112.
  const Words& words() const { return words_; }
  static ExactSum from_words(const Words& words);

  bool operator==(const ExactSum&) const = default;

 private:
  bool invalid() const;

  Words words_{};
};

}  // namespace scintray::core
