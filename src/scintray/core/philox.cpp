#include "scintray/core/philox.hpp"

namespace scintray::core {

namespace {

/// The 128 bits of a product.
struct WideProduct {
  std::uint64_t high, low;

  WideProduct(std::uint64_t a, std::uint64_t b) {
    __extension__ using Wide = unsigned __int128;
    const Wide product = static_cast<Wide>(a) * b;
    high = static_cast<std::uint64_t>(product >> 64);
    low = static_cast<std::uint64_t>(product);
  }
};

}  // namespace

std::array<std::uint64_t, 4> philox4x64(std::array<std::uint64_t, 4> counter,
                                        std::array<std::uint64_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const WideProduct first(counter[0], 0xD2E7470EE14C6C93ULL), second(counter[2], 0xCA5A826395121157ULL);
    counter = {second.high ^ counter[1] ^ key[0], second.low, first.high ^ counter[3] ^ key[1], first.low};
    key[0] += 0x9E3779B97F4A7C15ULL;
    key[1] += 0xBB67AE8584CAA73BULL;
  }
  return counter;
}

}  // namespace scintray::core
