#pragma once
/// Random numbers: one independent stream per photon.
///
/// A stream starts at a state of xoroshiro128++ that Philox computes from its address: Philox makes the
/// streams independent, whatever their addresses, and xoroshiro128++ draws the numbers of each in a fifth of
/// the instructions. Two of N streams of L numbers each overlap with a probability of N^2 L / 2^128.

#include "scintray/core/xoroshiro.hpp"

namespace scintray::core {

/// Family of independent streams that a generator draws from; photons never share numbers with other uses of
/// the same seed.
enum class StreamKind : std::uint64_t {
  photon = 0,     ///< (event, photon)
  event = 1,      ///< (event, 0): positions and energies of a whole event
  table = 2,      ///< (incidence node and side, ray): building a surface table
  synthesis = 3,  ///< synthesising a height map
  other = 4,
  sensor = 5,      ///< (event, channel): noise of a sensor and its electronics
  cell = 6,        ///< (cell, photon) of a grid: building a response map
  mapped = 7,      ///< (event, 0): an event simulated with a response map
  conversion = 8,  ///< (event, photon / 4): the conversion draws of four photons
};

/// A random stream addressed by (seed, kind, a, b, set). Streams with different addresses are
/// independent; the same address always generates the same numbers, on any thread.
class Rng {
 public:
  Rng(std::uint64_t seed, StreamKind kind, std::uint64_t a, std::uint64_t b = 0, std::uint64_t set = 0);

  using State = Xoroshiro<std::uint64_t>;
  /// Where the stream is: that of two streams is equal when all their numbers from here on are.
  const State& state() const { return state_; }
  /// Goes on from where another has drawn numbers of this stream to.
  void go_on_from(const State& state) { state_ = state; }

  /// 64 random bits.
  std::uint64_t bits() { return state_.next(); }

  /// Uniform on [0, 1), 52 bits.
  double uniform() { return uniform_of<double>(bits()); }
  /// Uniform on (0, 1]: safe as the argument of a logarithm.
  double uniform_positive() { return uniform_positive_of<double>(bits()); }

 private:
  State state_;
};

}  // namespace scintray::core
