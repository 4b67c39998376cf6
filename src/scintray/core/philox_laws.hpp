#pragma once
/// Philox4x64-10 over a type of 64-bit numbers (number.hpp): one block, or one in each lane.
///
/// Source: J. K. Salmon et al. 2011, "Parallel random numbers: as easy as 1, 2, 3", SC'11 (table 2, section
/// 4.3).

#include "scintray/core/number.hpp"

namespace scintray::core {

/// The 128 bits of a product of two 64-bit numbers.
template <typename Bits>
struct WideProduct {
  Bits high, low;
};
[[gnu::always_inline]] inline WideProduct<std::uint64_t> wide_product(std::uint64_t a, std::uint64_t b) {
#ifdef __BMI2__
  // GCC 12 keeps the halves of a 128-bit product together and copies them to and fro.
  WideProduct<std::uint64_t> product;
  asm("mulx %3, %1, %0" : "=r"(product.high), "=r"(product.low) : "d"(a), "rm"(b));
  return product;
#else
  __extension__ using Wide = unsigned __int128;
  const Wide product = static_cast<Wide>(a) * b;
  return {static_cast<std::uint64_t>(product >> 64), static_cast<std::uint64_t>(product)};
#endif
}

/// The keys of all rounds.
template <typename Bits>
struct PhiloxKeys {
  Bits of[10][2];

  PhiloxKeys() = default;
  [[gnu::always_inline]] PhiloxKeys(const Bits& first, const Bits& second) : of{{first, second}} {
    for (int round = 1; round < 10; ++round) {
      of[round][0] = of[round - 1][0] + Bits(0x9E3779B97F4A7C15ULL);
      of[round][1] = of[round - 1][1] + Bits(0xBB67AE8584CAA73BULL);
    }
  }
};

/// 256 random bits of a counter under a key.
template <typename Bits>
struct PhiloxBlock {
  struct Counter {
    Bits of[4];
  };
  Bits words[4];

  /// @tparam Key  Bits, or std::uint64_t where all lanes have one key
  template <typename Key>
  [[gnu::always_inline]] PhiloxBlock(const Counter& counter, const PhiloxKeys<Key>& keys)
      : words{counter.of[0], counter.of[1], counter.of[2], counter.of[3]} {
    constexpr std::uint64_t kMultiplier[2] = {0xD2E7470EE14C6C93ULL, 0xCA5A826395121157ULL};
    for (int round = 0; round < 10; ++round) {
      const WideProduct<Bits> first = wide_product(words[0], Bits(kMultiplier[0]));
      const WideProduct<Bits> second = wide_product(words[2], Bits(kMultiplier[1]));
      words[0] = second.high ^ words[1] ^ Bits(keys.of[round][0]);
      words[1] = second.low;
      words[2] = first.high ^ words[3] ^ Bits(keys.of[round][1]);
      words[3] = first.low;
    }
  }
};

}  // namespace scintray::core
