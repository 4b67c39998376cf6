#include "scintray/core/exact_sum.hpp"

#include <bit>
#include <cmath>
#include <limits>

namespace scintray::core {

namespace {

constexpr int kFractionBits = 112, kMostExponent = 100, kMantissaBits = 52, kExponentBias = 1023;

/// What no sum of valid addends reaches: the most negative number.
constexpr ExactSum::Words kInvalid{0, 0, 0, std::uint64_t{1} << 63};

/// Adds a number of one word at bit 64 * `word`.
void add_word(ExactSum::Words& words, std::size_t word, std::uint64_t more) {
  for (; more != 0 && word < words.size(); ++word) {
    words[word] += more;
    more = words[word] < more ? 1 : 0;
  }
}

void subtract_word(ExactSum::Words& words, std::size_t word, std::uint64_t less) {
  for (; less != 0 && word < words.size(); ++word) {
    const std::uint64_t before = words[word];
    words[word] -= less;
    less = before < less ? 1 : 0;
  }
}

void negate(ExactSum::Words& words) {
  for (std::uint64_t& word : words) word = ~word;
  add_word(words, 0, 1);
}

int highest_bit(const ExactSum::Words& words) {
  for (int word = 3; word >= 0; --word)
    if (const std::uint64_t bits = words[static_cast<std::size_t>(word)]; bits != 0)
      return 64 * word + 63 - std::countl_zero(bits);
  return -1;
}

bool bit_at(const ExactSum::Words& words, int bit) {
  return (words[static_cast<std::size_t>(bit / 64)] >> (bit % 64) & 1u) != 0;
}

bool any_below(const ExactSum::Words& words, int bit) {
  for (int word = 0; word < bit / 64; ++word)
    if (words[static_cast<std::size_t>(word)] != 0) return true;
  const std::uint64_t mask = (std::uint64_t{1} << (bit % 64)) - 1;
  return (words[static_cast<std::size_t>(bit / 64)] & mask) != 0;
}

}  // namespace

bool ExactSum::invalid() const { return words_ == kInvalid; }

ExactSum ExactSum::from_words(const Words& words) {
  ExactSum sum;
  sum.words_ = words;
  return sum;
}

void ExactSum::add(double addend) {
  if (invalid()) return;
  const auto bits = std::bit_cast<std::uint64_t>(addend);
  const int exponent = static_cast<int>(bits >> kMantissaBits & 0x7ff);
  if (exponent == 0) return;  // zero, or far below the last bit
  if (exponent - kExponentBias >= kMostExponent) {
    words_ = kInvalid;
    return;
  }
  constexpr std::uint64_t kOne = std::uint64_t{1} << kMantissaBits;
  std::uint64_t mantissa = (bits & (kOne - 1)) | kOne;
  int shift = exponent - kExponentBias - kMantissaBits + kFractionBits;
  if (shift < 0) {
    if (shift <= -64) return;
    mantissa >>= -shift;
    shift = 0;
  }
  const auto word = static_cast<std::size_t>(shift / 64);
  const int offset = shift % 64;
  const std::uint64_t low = mantissa << offset, high = offset == 0 ? 0 : mantissa >> (64 - offset);
  if (addend > 0.0) {
    add_word(words_, word, low);
    add_word(words_, word + 1, high);
  } else {
    subtract_word(words_, word, low);
    subtract_word(words_, word + 1, high);
  }
}

void ExactSum::merge(const ExactSum& other) {
  if (invalid() || other.invalid()) {
    words_ = kInvalid;
    return;
  }
  for (std::size_t word = 0; word < words_.size(); ++word) add_word(words_, word, other.words_[word]);
}

double ExactSum::value() const {
  if (invalid()) return std::numeric_limits<double>::quiet_NaN();
  Words magnitude = words_;
  const bool negative = words_[3] >> 63 != 0;
  if (negative) negate(magnitude);
  const int top = highest_bit(magnitude);
  if (top < 0) return 0.0;
  const int last = top - kMantissaBits;  // the bit that becomes the mantissa's last
  std::uint64_t mantissa = 0;
  for (int bit = top; bit >= 0 && bit >= last; --bit)
    mantissa = mantissa << 1 | (bit_at(magnitude, bit) ? 1u : 0u);
  if (last > 0 && bit_at(magnitude, last - 1) && (any_below(magnitude, last - 1) || (mantissa & 1u) != 0))
    ++mantissa;
  const double value = std::ldexp(static_cast<double>(mantissa), (last > 0 ? last : 0) - kFractionBits);
  return negative ? -value : value;
}

}  // namespace scintray::core
