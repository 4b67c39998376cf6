#pragma once
/// Random numbers: one independent stream per photon.
///
/// A stream starts at a state that its address determines, and draws its numbers by xoroshiro128++. Philox
/// computes from seed, kind, a and set where SplitMix64 starts, and this makes a state for each b: sequences
/// of SplitMix64 are what the authors of xoroshiro128++ recommend for its first states. Of N streams with L
/// numbers each, two have a number in common with a probability of N^2 L / 2^128.
///
/// Source of SplitMix64: G. L. Steele, D. Lea and C. H. Flood 2014, "Fast Splittable Pseudorandom Number
/// Generators", OOPSLA '14; the constants are those of S. Vigna's program splitmix64.c.

#include <array>

#include "scintray/core/xoroshiro.hpp"

namespace scintray::core {

/// Family of independent streams that a generator draws from; photons never share numbers with other uses of
/// the same seed.
enum class StreamKind : std::uint64_t {
  photon = 0,  ///< (event, photon)
  event = 1,   ///< (event, 0): positions and energies of a whole event
  table = 2,   ///< (incidence node and side, ray): building a surface table
  other = 4,
  sensor = 5,  ///< (event, channel): noise of a sensor and its electronics
  cell = 6,    ///< (cell, photon) of a grid: building a response map
  mapped = 7,  ///< (event, 0): an event simulated with a response map
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
  friend class StreamFamily;
  explicit Rng(const State& state) : state_(state) {}

  State state_;
};

/// Number `place` of the sequence of SplitMix64 that starts at `start`: 64 random bits.
inline std::uint64_t splitmix64_at(std::uint64_t start, std::uint64_t place) {
  std::uint64_t z = start + (place + 1) * 0x9E3779B97F4A7C15ULL;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

/// The streams whose addresses differ in b alone.
class StreamFamily {
 public:
  StreamFamily(std::uint64_t seed, StreamKind kind, std::uint64_t a, std::uint64_t set = 0);

  Rng at(std::uint64_t b) const {
    const std::uint64_t first = splitmix64_at(start_[0], b), second = splitmix64_at(start_[1], b);
    // One in 2^128 has a state of zeros, which would stay so.
    return Rng(Rng::State{first, (first | second) != 0 ? second : 1});
  }
  /// 64 random bits for each b, independent of those of the streams.
  std::uint64_t bits_at(std::uint64_t b) const { return splitmix64_at(start_[2], b); }

 private:
  std::array<std::uint64_t, 4> start_;
};

}  // namespace scintray::core
