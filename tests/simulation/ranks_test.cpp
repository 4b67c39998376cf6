// A run by several ranks: the same results, the errors of each, and what a stop leaves.
#include <doctest/doctest.h>

#include "ranks_in_threads.hpp"
#include "scenes.hpp"
#include "scintray/core/cancelled.hpp"
#include "scintray/simulation/detail/rank_work.hpp"
#include "scintray/simulation/memory_sink.hpp"
#include "scintray/simulation/ranks.hpp"
#include "scintray/simulation/simulation.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::simulation;
using namespace scintray::test;

namespace {

Simulation simulation_of(const std::string& scene, std::uint64_t photons = 0) {
  SimulationOptions options;
  options.threads = 2;
  if (photons > 0) options.photons = photons;
  return Simulation(scene_of(scene), options);
}

void check_same(const MemorySink& a, const MemorySink& b) {
  REQUIRE(a.result.points.size() == b.result.points.size());
  REQUIRE(a.photon_list.size() == b.photon_list.size());
  for (std::size_t i = 0; i < a.photon_list.size(); ++i) {
    CHECK(a.photon_list[i].photon == b.photon_list[i].photon);
    CHECK(a.photon_list[i].time_ns == b.photon_list[i].time_ns);
  }
  for (std::size_t i = 0; i < a.result.points.size(); ++i) {
    const tally::PointResult &x = a.result.points[i], &y = b.result.points[i];
    CHECK(x.fates == y.fates);
    CHECK(x.complete == y.complete);
    CHECK(x.photons_requested == y.photons_requested);
    CHECK(x.detected_time_ns.sum == y.detected_time_ns.sum);
    CHECK(x.detected_time_ns.sum_of_squares == y.detected_time_ns.sum_of_squares);
    CHECK(x.energy.events == y.energy.events);
    CHECK(x.energy.deposited == y.energy.deposited);
  }
}

}  // namespace

TEST_CASE("1, 2, 3 and 5 ranks make the results of one process, of photons and of events") {
  const std::string rows = "[run]\nphoton_list = true\n";
  for (const std::string& scene : {kCrystal + kPhotons + rows + kSurfaceSweep, kCrystal + kEvents}) {
    const bool photons = scene.find("photon_list") != std::string::npos;
    MemorySink alone;
    simulation_of(scene, photons ? 30'500 : 0).run_all(alone);
    for (const int count : {1, 2, 3, 5}) {
      CAPTURE(count);
      MemorySink together;
      run_ranks(
          count, [&](int) { return simulation_of(scene, photons ? 30'500 : 0); }, together);
      CHECK(together.result.complete());
      check_same(alone, together);
    }
  }
}

TEST_CASE("The error of a rank is that of the run, with the number of the rank") {
  const std::string scene = kCrystal + kPhotons;
  MemorySink nothing;
  const auto message_of = [&](const MakeSimulation& make) -> std::string {
    try {
      run_ranks(3, make, nothing);
    } catch (const InputError& error) {
      return error.problems().front().what;
    } catch (const SystemError& error) {
      return std::string("system: ") + error.what();
    }
    return "";
  };
  CHECK(contains(
      message_of([&](int rank) { return simulation_of(rank == 2 ? scene + "[run]\nx = 1\n" : scene); }),
      "rank 2: "));
  CHECK(
      contains(message_of([&](int rank) { return simulation_of(scene, rank == 1 ? 2'100'000 : 2'000'000); }),
               "rank 1 would compute another run: there are 2100000 photons"));
  CHECK(message_of([&](int rank) -> Simulation {
          if (rank == 1) throw SystemError("the disk is gone");
          return simulation_of(scene);
        }) == "system: rank 1: the disk is gone");
  // The error of rank 0 is its own.
  CHECK(contains(message_of([&](int) { return simulation_of(scene + "[run]\nx = 1\n"); }), "x"));
}

TEST_CASE("A stop ends all ranks, and the run is resumed by ranks to the same results") {
  const std::string scene = kCrystal + kPhotons + "[run]\nphoton_list = true\n";
  const auto make = [&](int) { return simulation_of(scene, 200'000); };
  const CheckpointSettings settings{scratch_folder("ranks_stop") / "checkpoints",
                                    std::chrono::milliseconds(0), Resume::resume};
  MemorySink part, rest, alone;
  {
    Checkpoints checkpoints(settings);
    std::atomic<bool> stop{false};
    SimulationHooks hooks;
    hooks.checkpoints = &checkpoints;
    hooks.stop = &stop;
    hooks.progress = [&](const SimulationProgress& progress) { stop = stop || progress.done > 20'000; };
    run_ranks(3, make, part, hooks);
  }
  CHECK_FALSE(part.result.complete());
  CHECK(part.result.partial_reason == kStopped);
  CHECK(part.result.points.at(0).emitted > 20'000);
  CHECK(part.result.points.at(0).emitted < 200'000);
  Checkpoints checkpoints(settings);
  SimulationHooks hooks;
  hooks.checkpoints = &checkpoints;
  run_ranks(2, make, rest, hooks);
  make(0).run_all(alone);
  check_same(alone, rest);
}

TEST_CASE("A rank that takes work and hangs ends the run, with what was finished kept") {
  const auto folder = scratch_folder("hung_rank");
  const auto make = [] { return simulation_of(kCrystal + kPhotons, 300'000); };
  Exchange exchange(2);
  std::atomic<bool> over{false};
  // The other rank reports that it is ready, and then nothing.
  std::thread other([&] {
    ThreadRanks ranks(exchange, 1);
    Simulation simulation = make();
    ranks.send(0, simulation::detail::message(simulation::detail::RankReady{2, simulation.outline()}));
    while (!over) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  });
  ThreadRanks ranks(exchange, 0);
  const CheckpointSettings settings{folder / "checkpoints", std::chrono::milliseconds(0), Resume::resume};
  std::string said;
  {
    Checkpoints checkpoints(settings);
    SimulationHooks hooks;
    hooks.ranks = &ranks;
    ranks.silence = std::chrono::milliseconds(300);
    hooks.checkpoints = &checkpoints;
    MemorySink sink;
    try {
      make().run_all(sink, hooks);
    } catch (const SystemError& error) {
      said = error.what();
    }
  }
  over = true;
  other.join();
  check_contains(said, {"rank 1", "has not answered", "hangs"});
  // What rank 0 had merged before is there, and another run goes on from it.
  Checkpoints checkpoints(settings);
  SimulationHooks hooks;
  hooks.checkpoints = &checkpoints;
  MemorySink rest, alone;
  make().run_all(rest, hooks);
  make().run_all(alone);
  check_same(alone, rest);
}
