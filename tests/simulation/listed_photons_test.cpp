// Lists of photons with some columns, of a sample, and of some channels.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "ranks_in_threads.hpp"
#include "scenes.hpp"
#include "scintray/core/h5.hpp"
#include "scintray/simulation/analyze_results.hpp"
#include "scintray/simulation/memory_sink.hpp"
#include "scintray/simulation/results_file.hpp"
#include "scintray/simulation/simulation.hpp"
#include "support/same_results.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::simulation;
using namespace scintray::test;

namespace {

/// A crystal with a sensor at each end.
std::string two_ends() {
  return kCrystal + R"([[part]]
name = "far"
box = ["2 mm", "2 mm", "1 mm"]
place = { touch = "crystal", side = "+z" }
sensor = "R6231"
)";
}

std::string listed(const std::string& more = "", std::uint64_t seed = 1) {
  return "[run]\nphoton_list = true\nseed = " + std::to_string(seed) + "\n" + more;
}

MemorySink run_of(const std::string& scene) {
  MemorySink sink;
  Simulation(scene_of(scene)).run_all(sink);
  return sink;
}

using Number = std::pair<std::uint64_t, std::uint64_t>;

std::vector<Number> numbers(const std::vector<tally::DetectedPhoton>& photons) {
  std::vector<Number> all;
  for (const tally::DetectedPhoton& photon : photons) all.emplace_back(photon.event, photon.photon);
  return all;
}

}  // namespace

TEST_CASE("A list of photons has the columns that the scene chooses, and the rest is not known") {
  const auto folder = scratch_folder("photon_columns");
  const std::string scene = two_ends() + kPhotons;
  ResultsFile all(folder / "all.h5"), some(folder / "some.h5");
  Simulation(scene_of(scene + listed())).run_all(all);
  Simulation(scene_of(scene + listed("photon_columns = [\"time_ns\", \"part\"]\n"))).run_all(some);
  const auto whole = results::read_photons(folder / "all.h5", 0, 1'000'000),
             part = results::read_photons(folder / "some.h5", 0, 1'000'000);
  REQUIRE(part.size() == whole.size());
  REQUIRE(part.size() > 100);
  for (std::size_t i = 0; i < part.size(); ++i) {
    CHECK(part[i].time_ns == whole[i].time_ns);
    CHECK(part[i].part == whole[i].part);
    CHECK(part[i].point == 0);
    CHECK(std::isnan(part[i].path_mm));
    CHECK(std::isnan(part[i].position_mm[1]));
    CHECK_FALSE(part[i].face.has_value());
  }
  const auto columns = [&](const char* name) {
    std::vector<std::string> members = h5::File::open(folder / name).root().open_group("photons").members();
    std::erase(members, "row");
    std::sort(members.begin(), members.end());
    return members;
  };
  CHECK(columns("some.h5") == std::vector<std::string>{"part", "point", "time_ns"});
  // The words of scene files are the names of the columns.
  std::vector<std::string> known(std::begin(scene_file::kPhotonOutputColumns),
                                 std::end(scene_file::kPhotonOutputColumns));
  known.emplace_back("point");
  std::sort(known.begin(), known.end());
  CHECK(columns("all.h5") == known);
  CHECK(results::read_photon_layout(folder / "all.h5").is_whole());
  CHECK(results::read_photon_layout(folder / "some.h5").columns ==
        std::vector<std::string>{"time_ns", "part"});
}

TEST_CASE("A sample of one photon in n has the same photons whatever the seed, and its share of them") {
  std::string source = kPhotons;
  source.replace(source.find("3_000"), 5, "60_000");
  for (const std::uint64_t seed : {1, 2}) {
    const std::vector<Number> all = numbers(run_of(two_ends() + source + listed("", seed)).photon_list);
    const std::vector<Number> some =
        numbers(run_of(two_ends() + source + listed("photon_sample = 10\n", seed)).photon_list);
    REQUIRE(all.size() > 5000);
    CHECK(std::includes(all.begin(), all.end(), some.begin(), some.end()));
    // Binomial; 4 sigma fail a correct program once in 16,000.
    const double expected = static_cast<double>(all.size()) / 10.0;
    CHECK(std::abs(static_cast<double>(some.size()) - expected) < 4.0 * std::sqrt(0.9 * expected));
    // By its numbers alone: a photon that both seeds detect is in both samples or in neither.
    static std::vector<Number> all_before, some_before;
    if (seed == 2)
      for (const Number& one : all)
        if (std::binary_search(all_before.begin(), all_before.end(), one))
          CHECK(std::binary_search(some.begin(), some.end(), one) ==
                std::binary_search(some_before.begin(), some_before.end(), one));
    all_before = all;
    some_before = some;
  }
}

TEST_CASE("A list of some channels has their photons alone, and no other result changes") {
  const MemorySink all = run_of(two_ends() + kPhotons + listed());
  const MemorySink far = run_of(two_ends() + kPhotons + listed("photon_channels = \"f*\"\n"));
  std::vector<Number> expected;
  for (const tally::DetectedPhoton& photon : all.photon_list)
    if (all.result.header.parts.at(photon.part) == "far") expected.emplace_back(photon.event, photon.photon);
  REQUIRE(expected.size() > 50);
  REQUIRE(expected.size() < all.photon_list.size());
  CHECK(numbers(far.photon_list) == expected);
  CHECK(far.result.points.at(0).fates == all.result.points.at(0).fates);
  const std::string unknown = complaint_of([&] {
    Simulation(scene_of(two_ends() + kPhotons + listed("photon_channels = [\"pmt\", \"fart\"]\n"))).build();
  });
  check_contains(unknown, {"readout channel", "\"fart\""});
  check_contains(unknown, "did you mean \"far\"?");
}

TEST_CASE("Shards, ranks and a resumed run with a list of some columns make the same file") {
  const auto folder = scratch_folder("photon_list_shards");
  const std::string scene =
      two_ends() + kPhotons + kSurfaceSweep +
      listed("photon_sample = 3\nphoton_columns = [\"x_mm\", \"face\"]\nphoton_channels = \"pmt\"\n");
  ResultsFile one(folder / "one.h5"), merged(folder / "merged.h5"), ranks(folder / "ranks.h5"),
      stopped(folder / "stopped.h5"), resumed(folder / "resumed.h5");
  Simulation(scene_of(scene)).run_all(one);
  std::vector<std::filesystem::path> parts;
  for (const std::uint64_t number : {2, 1, 3}) {
    parts.push_back(folder / (std::to_string(number) + ".shard"));
    RangeFile file(parts.back(), {number, 3});
    Simulation(scene_of(scene)).run_all(file, {}, {number, 3});
  }
  merge_ranges(parts, merged);
  check_same_results(folder / "one.h5", folder / "merged.h5");
  run_ranks(
      2, [&](int) { return Simulation(scene_of(scene)); }, ranks);
  check_same_results(folder / "one.h5", folder / "ranks.h5");
  const CheckpointSettings settings{folder / "checkpoints", std::chrono::milliseconds(0), Resume::resume};
  for (const bool again : {false, true}) {
    Checkpoints checkpoints(settings);
    std::atomic<bool> stop{false};
    SimulationHooks hooks;
    hooks.checkpoints = &checkpoints;
    if (!again) hooks.stop = &stop;
    hooks.progress = [&](const SimulationProgress& progress) { stop = stop || progress.done > 0; };
    Simulation(scene_of(scene)).run_all(again ? resumed : stopped, hooks);
  }
  CHECK_FALSE(results::read_results(folder / "stopped.h5").complete());
  check_same_results(folder / "one.h5", folder / "resumed.h5");
}

TEST_CASE("Electronics are not applied again to a list without all photons or columns") {
  const auto folder = scratch_folder("photon_list_rerun");
  ResultsFile file(folder / "a.h5");
  Simulation(scene_of(two_ends() + kEvents + listed("photon_sample = 2\n"))).run_all(file);
  const std::string said = complaint_of([&] {
    rerun_readout(folder / "a.h5", results::read_results(folder / "a.h5"), detector::ReadoutSpec(),
                  folder / "b.h5");
  });
  check_contains(said, "not all columns of every photon");
  check_contains(said, {"remove", "photon_sample"});
}
