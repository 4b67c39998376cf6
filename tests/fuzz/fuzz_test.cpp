/// Every reader against files damaged at random, from a fixed seed.

#include <doctest/doctest.h>

#include <fstream>
#include <iterator>

#include "corpus.hpp"
#include "entries.hpp"
#include "mutate.hpp"
#include "support/shared.hpp"
#include "watched_run.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::fuzz;

TEST_CASE("the seeds are sound: every one is read by its own format") {
  for (const Entry& entry : entries()) {
    CAPTURE(std::string(entry.name));
    for (const std::string& seed : sound_seeds(entry)) CHECK(watched_run(entry, seed));
    for (const std::string& content : found(entry.name)) watched_run(entry, content);
  }
}

TEST_CASE("readers throw only input errors, and allocate no more than the file can fill") {
  constexpr int kTrials = 10000;
  std::uint64_t stream = 0;
  for (const Entry& entry : entries()) {
    CAPTURE(std::string(entry.name));
    const std::vector<std::string> seeds = all_seeds(entry);
    Rng rng(20261121, StreamKind::other, ++stream);
    int read = 0;
    for (int trial = 0; trial < kTrials; ++trial)
      read += watched_run(entry, mutated(seeds[static_cast<std::size_t>(trial) % seeds.size()], seeds, rng))
                  ? 1
                  : 0;
    // Damage that is always, or never, noticed would leave one of the two outcomes untried.
    CHECK(read > kTrials / 1000);
    CHECK(read < kTrials - kTrials / 1000);
  }
}

TEST_CASE("every file cut short after any byte ends in a map or an input error") {
  for (const Entry& entry : entries())
    for (const std::string& seed : all_seeds(entry))
      for (std::size_t size = 0; size<seed.size(); size += seed.size()> 2000 ? 7 : 1)
        watched_run(entry, seed.substr(0, size));
}

TEST_CASE("published files damaged at random end in a map or an input error") {
  const Entry& any = entries().back();
  std::uint64_t stream = 0;
  for (const char* name : {"di-3.di", "mi-1.mi", "P0089OP0027.ibw", "10x10-one_channel_without_name.ibw",
                           "gwyfile-test.gwy", "chip.gwy", "sdf-1.sdf", "sample-land.x3p", "xyz-1.txt"}) {
    const auto path = test::shared_file(std::string("data/topography/") + name);
    if (!path) return;
    std::ifstream file(*path, std::ios::binary);
    const std::vector<std::string> seed{std::string((std::istreambuf_iterator<char>(file)), {})};
    Rng rng(20261122, StreamKind::other, ++stream);
    CAPTURE(name);
    CHECK(watched_run(any, seed.front()));
    for (int trial = 0; trial < 20; ++trial) watched_run(any, mutated(seed.front(), seed, rng));
  }
}
