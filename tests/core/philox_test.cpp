#include <doctest/doctest.h>

#include "scintray/core/philox.hpp"

using namespace scintray;
using namespace scintray::core;

TEST_CASE("Philox4x64-10 has the published known answers") {
  // Random123 1.14, tests/kat_vectors, lines "philox4x64 10".
  CHECK(philox4x64({0, 0, 0, 0}, {0, 0}) ==
        std::array<std::uint64_t, 4>{0x16554d9eca36314cULL, 0xdb20fe9d672d0fdcULL, 0xd7e772cee186176bULL,
                                     0x7e68b68aec7ba23bULL});
  const std::uint64_t ones = ~0ULL;
  CHECK(philox4x64({ones, ones, ones, ones}, {ones, ones}) ==
        std::array<std::uint64_t, 4>{0x87b092c3013fe90bULL, 0x438c3c67be8d0224ULL, 0x9cc7d7c69cd777b6ULL,
                                     0xa09caebf594f0ba0ULL});
}

TEST_CASE("Streams with different addresses differ, equal addresses repeat") {
  Rng a(1, StreamKind::photon, 2, 3), b(1, StreamKind::photon, 2, 3), c(1, StreamKind::photon, 3, 2);
  const auto first = a.bits();
  CHECK(first == b.bits());
  CHECK(first != c.bits());
}
