#pragma once
/// Counter-based random numbers: one independent stream per photon.
///
/// Source: J. K. Salmon et al. 2011, "Parallel random numbers: as easy as 1, 2, 3", SC'11,
/// Philox4x64-10 (table 2, section 4.3). The same generator as numpy.random.Philox.

#include <array>
#include <cstdint>

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

  /// 64 random bits.
  std::uint64_t bits() {
    if (used_ == 4) refill();
    return buffer_[used_++];
  }

  /// Uniform on [0, 1), 53 bits.
  double uniform() { return to_uniform(bits()); }
  static double to_uniform(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1.0p-53; }

  /// Uniform on (0, 1]: safe as the argument of a logarithm.
  double uniform_positive() { return static_cast<double>((bits() >> 11) + 1) * 0x1.0p-53; }

 private:
  void refill() {
    buffer_ = philox4x64(counter_, key_);
    ++counter_[0];
    used_ = 0;
  }

  std::array<std::uint64_t, 4> counter_;
  std::array<std::uint64_t, 2> key_;
  std::array<std::uint64_t, 4> buffer_{};
  int used_ = 4;
};

inline std::array<std::uint64_t, 4> philox4x64(std::array<std::uint64_t, 4> counter,
                                               std::array<std::uint64_t, 2> key) {
  constexpr std::uint64_t kMultiplier0 = 0xD2E7470EE14C6C93ULL;
  constexpr std::uint64_t kMultiplier1 = 0xCA5A826395121157ULL;
  constexpr std::uint64_t kWeyl0 = 0x9E3779B97F4A7C15ULL;
  constexpr std::uint64_t kWeyl1 = 0xBB67AE8584CAA73BULL;
  __extension__ using Wide = unsigned __int128;
  for (int round = 0; round < 10; ++round) {
    if (round > 0) {
      key[0] += kWeyl0;
      key[1] += kWeyl1;
    }
    const Wide product0 = static_cast<Wide>(kMultiplier0) * counter[0];
    const Wide product1 = static_cast<Wide>(kMultiplier1) * counter[2];
    counter = {static_cast<std::uint64_t>(product1 >> 64) ^ counter[1] ^ key[0],
               static_cast<std::uint64_t>(product1),
               static_cast<std::uint64_t>(product0 >> 64) ^ counter[3] ^ key[1],
               static_cast<std::uint64_t>(product0)};
  }
  return counter;
}

}  // namespace scintray::core
