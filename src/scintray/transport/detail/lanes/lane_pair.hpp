#pragma once
/// Numbers in the lanes of two vector registers, with the operations of core/number.hpp: each operation is
/// made twice, on numbers that do not depend on each other, so that a processor has something to do while it
/// waits for the one before. What is decided for all lanes together is decided half as often.

#include "scintray/transport/detail/lanes/lane_number.hpp"

namespace scintray::transport {

template <typename Arch>
struct LaneRealPair;

/// The results of a comparison in each lane.
template <typename Arch>
struct LaneMaskPair {
  LaneMask<Arch> a, b;

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
  friend LaneRealPair<Arch> value_of(const LaneBitsPair& x) { return {value_of(x.a), value_of(x.b)}; }
  friend core::WideProduct<LaneBitsPair> wide_product(const LaneBitsPair& x, const LaneBitsPair& y) {
    const core::WideProduct<One> first = wide_product(x.a, y.a), second = wide_product(x.b, y.b);
    return {{first.high, second.high}, {first.low, second.low}};
  }
};

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
  friend Bits bits_of(const LaneRealPair& x) { return {bits_of(x.a), bits_of(x.b)}; }
  friend LaneRealPair root(const LaneRealPair& x) { return {root(x.a), root(x.b)}; }
  friend LaneRealPair magnitude(const LaneRealPair& x) { return {magnitude(x.a), magnitude(x.b)}; }
};

}  // namespace scintray::transport
