#include "core_clock.hpp"

#include <cstdint>

#include "clock.hpp"
#include "spread.hpp"

namespace scintray::bench {

namespace {

constexpr int kMeasurements = 200, kTurns = 50'000, kInTurn = 16;

/// Adds a number to a register kTurns * kInTurn times; the empty statement keeps each addition.
void add_in_a_row() {
  std::uint64_t sum = 0, step = 3;
  for (int turn = 0; turn < kTurns; ++turn) {
#pragma GCC unroll 16
    for (int i = 0; i < kInTurn; ++i) {
      sum += step;
      asm volatile("" : "+r"(sum), "+r"(step));
    }
  }
}

}  // namespace

double core_clock_per_ns() {
  std::vector<double> clocks;
  for (int i = 0; i < kMeasurements; ++i) {
    const double start = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
    add_in_a_row();
    const double seconds = clock_seconds(CLOCK_THREAD_CPUTIME_ID) - start;
    clocks.push_back(1e-9 * kTurns * kInTurn / seconds);
  }
  return spread_of(clocks).median;
}

}  // namespace scintray::bench
