#pragma once
/// Counter-based random numbers: one independent stream per photon.
///
/// Source: J. K. Salmon et al. 2011, "Parallel random numbers: as easy as 1, 2, 3", SC'11,
/// Philox4x64-10 (table 2, section 4.3). The same generator as numpy.random.Philox.

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "scintray/core/philox_laws.hpp"

namespace scintray::core {

/// Philox4x64-10 of `counter` under `key`: 256 random bits.
std::array<std::uint64_t, 4> philox4x64(std::array<std::uint64_t, 4> counter,
                                        std::array<std::uint64_t, 2> key);

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
  Rng(std::uint64_t seed, StreamKind kind, std::uint64_t a, std::uint64_t b = 0, std::uint64_t set = 0)
      : counter_{0, b, a, static_cast<std::uint64_t>(kind)}, key_{seed, set} {}

  /// Becomes the stream of another address.
  void restart(std::uint64_t seed, StreamKind kind, std::uint64_t a, std::uint64_t b, std::uint64_t set) {
    counter_ = {0, b, a, static_cast<std::uint64_t>(kind)};
    key_ = {seed, set};
    used_ = kDrawn;
  }

  /// Numbers of two blocks.
  static constexpr int kDrawn = 8;
  using Numbers = std::array<std::uint64_t, kDrawn>;
  /// Counter of the next block, and its key.
  const std::array<std::uint64_t, 4>& counter() const { return counter_; }
  const std::array<std::uint64_t, 2>& key() const { return key_; }
  /// The two blocks before that; where only one was drawn, it is the second.
  const Numbers& drawn() const { return drawn_; }
  /// Place in the stream of the next number to be drawn, from 0.
  std::uint64_t position() const { return 4 * counter_[0] + static_cast<std::uint64_t>(used_) - kDrawn; }
  /// Goes on at a place of this stream.
  /// @param block  the numbers of the block of four around the place before it, as another has drawn them
  void go_on_at(std::uint64_t position, const std::uint64_t* block) {
    counter_[0] = (position + 3) / 4;
    const std::uint64_t in_block = position % 4;
    used_ = in_block == 0 ? kDrawn : kDrawn / 2 + static_cast<int>(in_block);
    for (std::size_t i = 0; i < 4; ++i) drawn_[kDrawn / 2 + i] = block[i];
  }
  /// Goes on by whole blocks that the caller has drawn, to where as many numbers as before are left.
  /// @param last  their last numbers
  void skip_blocks(std::uint64_t blocks, const Numbers& last) {
    counter_[0] += blocks;
    drawn_ = last;
  }

  /// Goes on by two blocks, whose numbers the caller has drawn for several streams together and stores at the
  /// returned place: those of counter() and the one after it. None may be left of the blocks before.
  std::uint64_t* take_two_blocks() {
    counter_[0] += 2;
    used_ = 0;
    return drawn_.data();
  }
  /// The next numbers, as many as are drawn already.
  std::span<const std::uint64_t> ahead() const {
    return std::span(drawn_).subspan(static_cast<std::size_t>(used_));
  }
  /// Goes on by some of the numbers that are drawn already.
  void skip(int numbers) { used_ += numbers; }

  /// 64 random bits.
  std::uint64_t bits() {
    if (used_ == kDrawn) refill();
    return drawn_[static_cast<std::size_t>(used_++)];
  }

  /// Uniform on [0, 1), 53 bits.
  double uniform() { return to_uniform(bits()); }
  static double to_uniform(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1.0p-53; }

  /// Uniform on (0, 1]: safe as the argument of a logarithm.
  double uniform_positive() { return static_cast<double>((bits() >> 11) + 1) * 0x1.0p-53; }

 private:
  void refill() {
    const std::array<std::uint64_t, 4> block = philox4x64(counter_, key_);
    for (std::size_t i = 0; i < 4; ++i) drawn_[kDrawn / 2 + i] = block[i];
    ++counter_[0];
    used_ = kDrawn / 2;
  }

  std::array<std::uint64_t, 4> counter_;
  std::array<std::uint64_t, 2> key_;
  Numbers drawn_{};
  int used_ = kDrawn;
};

inline std::array<std::uint64_t, 4> philox4x64(std::array<std::uint64_t, 4> counter,
                                               std::array<std::uint64_t, 2> key) {
  using Block = PhiloxBlock<std::uint64_t>;
  const Block block(Block::Counter{{counter[0], counter[1], counter[2], counter[3]}},
                    PhiloxKeys<std::uint64_t>(key[0], key[1]));
  return {block.words[0], block.words[1], block.words[2], block.words[3]};
}

}  // namespace scintray::core
