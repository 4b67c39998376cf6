/// The readers of scenes and of ScintRay's own files against files damaged at random, from a fixed seed.

#include <doctest/doctest.h>

#include <string_view>

#include "corpus.hpp"
#include "mutate.hpp"
#include "own_entries.hpp"
#include "scintray/core/rng.hpp"
#include "watched_run.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::fuzz;

TEST_CASE("own files: the seeds are sound") {
  for (const Entry& entry : own_entries()) {
    CAPTURE(std::string(entry.name));
    for (const std::string& seed : sound_seeds(entry)) CHECK(watched_run(entry, seed));
    for (const std::string& content : found(entry.name)) watched_run(entry, content);
  }
}

TEST_CASE("own files: damaged ones are read or end in an input error") {
  // Every HDF5 file without a seal is first read by a process of its own.
  constexpr int kTextTrials = 2000, kFileTrials = 60;
  std::uint64_t stream = 0;
  for (const Entry& entry : own_entries()) {
    CAPTURE(std::string(entry.name));
    const std::vector<std::string> seeds = all_seeds(entry);
    Rng rng(20261124, StreamKind::other, ++stream);
    const std::string_view name = entry.name;
    const bool text =
        name == "scene" || name.starts_with("ranges") || name.starts_with("map_shard") || name == "journal";
    int read = 0;
    const int trials = text ? kTextTrials : kFileTrials;
    for (int trial = 0; trial < trials; ++trial) {
      const std::string& seed = seeds[static_cast<std::size_t>(trial) % seeds.size()];
      read += watched_run(entry, mutated(seed, seeds, rng)) ? 1 : 0;
    }
    CHECK(read < trials);
  }
}
