/// The readers of geometry, of detectors and of curves against files damaged at random, from a fixed seed.

#include <doctest/doctest.h>

#include <string_view>
#include <vector>

#include "corpus.hpp"
#include "curve_entries.hpp"
#include "detector_entries.hpp"
#include "geometry_entries.hpp"
#include "mutate.hpp"
#include "scintray/core/rng.hpp"
#include "watched_run.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::fuzz;

namespace {

std::vector<Entry> read_entries() {
  std::vector<Entry> entries(geometry_entries().begin(), geometry_entries().end());
  entries.insert(entries.end(), detector_entries().begin(), detector_entries().end());
  entries.insert(entries.end(), curve_entries().begin(), curve_entries().end());
  return entries;
}

}  // namespace

TEST_CASE("geometry: the seeds are sound") {
  for (const Entry& entry : read_entries()) {
    CAPTURE(std::string(entry.name));
    for (const std::string& seed : sound_seeds(entry)) CHECK(watched_run(entry, seed));
    for (const std::string& content : found(entry.name)) watched_run(entry, content);
  }
}

TEST_CASE("geometry: damaged files end in a whole mesh or an input error, within bounded memory") {
  // Every STEP file takes a process of its own; sanitized ones take many times as long.
#ifdef SCINTRAY_SANITIZED
  constexpr int kMostTrials = 300, kStepTrials = 30;
#else
  constexpr int kMostTrials = 1000, kStepTrials = 150;
#endif
  std::uint64_t stream = 0;
  for (const Entry& entry : read_entries()) {
    CAPTURE(std::string(entry.name));
    const std::vector<std::string> seeds = all_seeds(entry);
    Rng rng(20261123, StreamKind::other, ++stream);
    const int trials = std::string_view(entry.name) == "step" ? kStepTrials : kMostTrials;
    int read = 0;
    for (int trial = 0; trial < trials; ++trial) {
      const std::string& seed = seeds[static_cast<std::size_t>(trial) % seeds.size()];
      read += watched_run(entry, mutated(seed, seeds, rng)) ? 1 : 0;
    }
    // Damage that is always, or never, noticed would leave one of the two outcomes untried.
    CHECK(read > trials / 100);
    CHECK(read < trials - trials / 100);
  }
}

TEST_CASE("geometry: files cut short end in a mesh or an input error") {
#ifdef SCINTRAY_SANITIZED
  constexpr std::size_t kLengths = 20;
#else
  constexpr std::size_t kLengths = 100;
#endif
  for (const Entry& entry : read_entries())
    for (const std::string& seed : all_seeds(entry))
      for (std::size_t size = 0; size < seed.size(); size += 1 + seed.size() / kLengths)
        watched_run(entry, seed.substr(0, size));
}
