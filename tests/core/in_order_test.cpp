#include "scintray/core/in_order.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

using namespace scintray;

TEST_CASE("as many threads work as are requested, also more than the machine has processors") {
  // Each piece waits for the others: with fewer threads the last of them would never begin.
  const int threads = static_cast<int>(std::thread::hardware_concurrency()) + 3;
  std::atomic<int> waiting{0};
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  const auto wait_for_all = [&](std::uint64_t) {
    ++waiting;
    while (waiting < threads && std::chrono::steady_clock::now() < end)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return waiting.load();
  };
  const auto count = static_cast<std::uint64_t>(threads);
  int most = 0;
  CHECK(core::work_in_order(count, threads, nullptr, wait_for_all,
                            [&](std::uint64_t, int seen) { most = std::max(most, seen); }) == count);
  CHECK(most == threads);
  CHECK(std::chrono::steady_clock::now() < end);
}
