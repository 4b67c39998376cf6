// Runs that end by [run] until: where, with what, and how far their results can be trusted.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

#include "ranks_in_threads.hpp"
#include "scenes.hpp"
#include "scintray/simulation/analyze_results.hpp"
#include "scintray/simulation/detail/until_watch.hpp"
#include "scintray/simulation/memory_sink.hpp"
#include "scintray/simulation/results_file.hpp"
#include "scintray/simulation/simulation.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::simulation;
using namespace scintray::test;

namespace {

/// A crystal of which light is lost at its faces, so that runs are short.
std::string dim_crystal() { return painted_crystal(0.5); }
const std::string kManyPhotons = R"(
[source]
type = "photons"
region = { part = "crystal" }
wavelength = "emission"
photons = 100_000
)";
std::string events_of(const std::string& energy) {
  return R"(
[source]
type = "gamma_events"
events = 2000
region = { part = "crystal" }
energy = ")" +
         energy + "\"\n";
}
const std::string kManyEvents = events_of("8 keV");
const std::string kDarkness = R"(
[[sweep]]
key = "surfaces.paint.reflectance"
values = [0.5, 0.2]
)";

std::string until(const std::string& conditions, const std::string& more = "") {
  return "[run]\nuntil = { " + conditions + " }\n" + more;
}

Simulation simulation_with(const std::string& scene, std::uint64_t seed = 1, int threads = 2) {
  SimulationOptions options;
  options.threads = threads;
  options.seed = seed;
  return Simulation(scene_of(scene), options);
}

void check_same_end(const MemorySink& a, const MemorySink& b) {
  REQUIRE(a.result.points.size() == b.result.points.size());
  REQUIRE(a.photon_list.size() == b.photon_list.size());
  REQUIRE(a.event_list.size() == b.event_list.size());
  for (std::size_t i = 0; i < a.photon_list.size(); ++i)
    CHECK(a.photon_list[i].photon == b.photon_list[i].photon);
  for (std::size_t i = 0; i < a.result.points.size(); ++i) {
    const tally::PointResult &x = a.result.points[i], &y = b.result.points[i];
    CHECK(x.fates == y.fates);
    CHECK(x.event_fates == y.event_fates);
    CHECK(x.complete);
    CHECK(y.complete);
    CHECK(x.detected_time_ns.sum == y.detected_time_ns.sum);
    REQUIRE((x.until && y.until));
    for (std::size_t k = 0; k < x.until->conditions.size(); ++k) {
      CHECK(x.until->conditions[k].met == y.until->conditions[k].met);
      CHECK(x.until->conditions[k].reached == y.until->conditions[k].reached);
    }
  }
}

}  // namespace

TEST_CASE("Decisions are at fixed block counts that grow by a tenth") {
  CHECK(simulation::detail::next_decision(0, false) == 4);
  CHECK(simulation::detail::next_decision(4, false) == 5);
  CHECK(simulation::detail::next_decision(0, true) == 32);
  CHECK(simulation::detail::next_decision(32, true) == 35);
  for (std::uint64_t blocks = 20; blocks < 1'000'000;
       blocks = simulation::detail::next_decision(blocks, false))
    CHECK(simulation::detail::next_decision(blocks, false) <= blocks + blocks / 10);
}

TEST_CASE("A run ends at the same photon for any threads, ranks and resumed runs, of photons and events") {
  for (const bool events : {false, true}) {
    const std::string goal = until("relative_error = \"4 %\"", events ? "" : "photon_list = true\n");
    const std::string scene = dim_crystal() + (events ? kManyEvents : kManyPhotons) + goal + kDarkness;
    MemorySink one;
    simulation_with(scene, 1, 1).run_all(one);
    for (const tally::PointResult& point : one.result.points) {
      REQUIRE(point.until);
      CHECK(point.until->ended());
      CHECK(point.until->is_reproducible());
      const Estimate share = point.fraction(Fate::detected);
      CHECK(share.error <= 0.04 * share.value);
      CHECK(point.until->conditions.at(0).reached == share.error / share.value);
      const std::uint64_t blocks = events ? point.energy.events : point.emitted / 1024;
      CHECK(simulation::detail::next_decision(blocks - 1, events) == blocks);
      CHECK(blocks < (events ? 2000u : 97u));
    }
    if (!events) {
      std::uint64_t detected = 0;
      for (const tally::PointResult& point : one.result.points) detected += point.count(Fate::detected);
      CHECK(one.photon_list.size() == detected);
    }
    MemorySink many, ranks, rest;
    simulation_with(scene, 1, 5).run_all(many);
    check_same_end(one, many);
    run_ranks(
        3, [&](int) { return simulation_with(scene); }, ranks);
    check_same_end(one, ranks);

    const CheckpointSettings settings{scratch_folder("until") / "checkpoints", std::chrono::milliseconds(0),
                                      Resume::resume};
    {
      // Stopped in the second point: the first has ended, and is not traced again.
      Checkpoints checkpoints(settings);
      std::atomic<bool> stop{false};
      SimulationHooks hooks;
      hooks.checkpoints = &checkpoints;
      hooks.stop = &stop;
      hooks.progress = [&](const SimulationProgress& progress) { stop = stop || progress.point == 1; };
      MemorySink part;
      simulation_with(scene).run_all(part, hooks);
      CHECK_FALSE(part.result.complete());
    }
    Checkpoints checkpoints(settings);
    SimulationHooks hooks;
    hooks.checkpoints = &checkpoints;
    simulation_with(scene).run_all(rest, hooks);
    check_same_end(one, rest);
  }
}

namespace {

struct Goal {
  std::string conditions, of, unit;
  bool events = false;
};

/// Of enough light each for a photopeak.
const std::string kBrightEvents = events_of("60 keV");
const std::string kDecay = "time = \"decay\"\n";
const std::string kWhen = R"(
[[tally]]
type = "count"
name = "when"
at = "detected"
part = "pmt"
axes = [{ variable = "part", names = ["pmt"] }, { variable = "time", from = "0 ns", to = "200 ns", bins = 4 }]
)";

/// The estimate that a goal names, by the analysis of the whole result.
Estimate estimate_of(const Goal& goal, const MemorySink& sink) {
  const tally::PointResult& point = sink.result.points.at(0);
  if (!goal.events) {
    Estimate score = point.tallies.at(0).per_photon(1, point.photons);
    return {point.birth_efficiency * score.value, point.birth_efficiency * score.error};
  }
  const analysis::EventAnalysis whole = analysis::analyze_events(
      sink.event_list, analysis_setup({}, sink.readouts.at(0).channels, sink.result.header.parts));
  if (goal.of == "photopeak") return whole.peak.fit.position;
  if (goal.of == "energy resolution") return whole.peak.fit.relative_fwhm;
  if (goal.of == "light per energy") return whole.light_per_keV;
  return analysis::quoted_fwhm(whole.pair_difference_ns.value());
}

}  // namespace

TEST_CASE("Runs end by a tally's bin, a photopeak, a CTR: at the same photon for any threads and ranks") {
  const std::vector<Goal> goals = {
      {"of = \"tally\", tally = \"when\", bin = [\"pmt\", \"60 ns\"], relative_error = \"7 %\"",
       "tally when, bin pmt, 60 ns", "1", false},
      {"of = \"photopeak\", relative_error = \"2 %\"", "photopeak", "photons", true},
      {"of = \"energy_resolution\", absolute_error = \"4 %\"", "energy resolution", "1", true},
      {"of = \"light_per_energy\", relative_error = \"1.5 %\"", "light per energy", "1/keV", true},
      {"of = \"ctr\", absolute_error = \"0.2 ns\"", "CTR", "ns", true}};
  for (const Goal& goal : goals) {
    CAPTURE(goal.of);
    const std::string scene = (goal.events ? painted_crystal(0.95) + kBrightEvents
                                           : dim_crystal() + kManyPhotons + kDecay + kWhen) +
                              until(goal.conditions);
    MemorySink one;
    simulation_with(scene, 1, 1).run_all(one);
    const tally::PointResult& point = one.result.points.at(0);
    REQUIRE(point.until);
    CHECK(point.until->of == goal.of);
    CHECK(point.until->unit == goal.unit);
    CHECK(point.until->ended());
    const std::uint64_t blocks = goal.events ? point.energy.events : point.emitted / 1024;
    CHECK(simulation::detail::next_decision(blocks - 1, goal.events) == blocks);
    const tally::UntilCondition& condition = point.until->conditions.at(0);
    const Estimate estimate = estimate_of(goal, one);
    CAPTURE(estimate.value);
    CHECK(condition.reached ==
          (condition.quantity == "relative_error" ? estimate.error / estimate.value : estimate.error));
    CHECK(condition.reached <= condition.goal);
    MemorySink many, ranks, rest;
    simulation_with(scene, 1, 5).run_all(many);
    check_same_end(one, many);
    run_ranks(
        3, [&](int) { return simulation_with(scene); }, ranks);
    check_same_end(one, ranks);
    const CheckpointSettings settings{scratch_folder("until_goal") / "checkpoints",
                                      std::chrono::milliseconds(0), Resume::resume};
    {
      Checkpoints checkpoints(settings);
      std::atomic<bool> stop{false};
      SimulationHooks hooks;
      hooks.checkpoints = &checkpoints;
      hooks.stop = &stop;
      hooks.progress = [&](const SimulationProgress& progress) { stop = progress.done > 20; };
      MemorySink part;
      simulation_with(scene).run_all(part, hooks);
    }
    Checkpoints checkpoints(settings);
    SimulationHooks hooks;
    hooks.checkpoints = &checkpoints;
    simulation_with(scene).run_all(rest, hooks);
    check_same_end(one, rest);
  }
}

TEST_CASE("A goal that names no bin of a tally is refused before the first photon, with its place") {
  const auto refused = [](const std::string& bin) {
    try {
      simulation_with(dim_crystal() + kManyPhotons + kWhen +
                      until("of = \"tally\", tally = \"when\", relative_error = 0.1" + bin))
          .build();
    } catch (const InputError& error) {
      CHECK(error.problems().front().where.line > 0);
      return error.problems().front().what + " | " + error.problems().front().hint;
    }
    return std::string("not refused");
  };
  check_contains(refused(""), {"2 axes", "0 entries", "part, time"});
  check_contains(refused(", bin = [\"pmt\"]"), {"2 axes", "1 entries"});
  check_contains(refused(", bin = [\"pnt\", \"3 ns\"]"), {"\"pnt\"", "\"pmt\""});
  check_contains(refused(", bin = [\"pmt\", \"3 mm\"]"), {"time", "not a unit"});
  check_contains(refused(", bin = [\"pmt\", 3]"), {"time", "no unit"});
  check_contains(refused(", bin = [\"pmt\", \"200 ns\"]"), {"200 ns", "0 to 200 ns"});
}

TEST_CASE("Points of a sweep share the wall time so that their errors come out alike") {
  using simulation::detail::time_shares;
  // Errors that fall with the root of the time: 1 s at 2 % and 1 s at 1 % are equal after 4 to 1.
  const std::vector<double> shares = time_shares({1.0, 1.0}, {0.02, 0.01});
  CHECK(shares.at(0) == doctest::Approx(0.8));
  CHECK(shares.at(1) == doctest::Approx(0.2));
  // A point with twice as slow photons takes twice the time for as many.
  CHECK(time_shares({2.0, 1.0}, {0.02, 0.02}).at(0) == doctest::Approx(2.0 / 3.0));
  // Errors that are not known are as the others.
  CHECK(time_shares({1.0, 1.0}, {0.0, 0.01}).at(0) == doctest::Approx(0.5));
  CHECK(time_shares({1.0, 1.0, 2.0}, {0.0, 0.0, 0.0}).at(2) == doctest::Approx(0.5));
  CHECK(time_shares({0.0, 0.0}, {0.0, 0.0}).at(0) == doctest::Approx(0.5));
}

#ifndef SCINTRAY_SANITIZED
// A sanitizer's trial can take longer than its part of the time.
TEST_CASE("By the clock, points of a sweep end, and not by each having half of the time") {
  SimulationOptions options;
  options.threads = 2;
  options.photons = 1'000'000'000;
  const std::string conditions = until("fate = \"detected\", wall_time = \"3 s\"");
  const tally::RunResult run =
      Simulation(scene_of(dim_crystal() + kManyPhotons + conditions + kDarkness), options).run_all();
  REQUIRE(run.points.size() == 2);
  double sum = 0.0;
  for (const tally::PointResult& point : run.points) {
    REQUIRE(point.until);
    CHECK(point.until->conditions.at(0).goal > 0.0);
    sum += point.until->conditions.at(0).goal;
  }
  CHECK(run.points[0].until->conditions[0].goal != run.points[1].until->conditions[0].goal);
  CHECK(sum < 6.0);
}

// 800 runs, for their numbers alone.
TEST_CASE("Ending by a relative error has no bias above its square, and errors cover as stated") {
  constexpr double kLimit = 4.0;
  constexpr std::uint64_t kRuns = 400;
  for (const bool events : {false, true}) {
    CAPTURE(events);
    const double goal = events ? 0.08 : 0.04;
    const std::string source = dim_crystal() + (events ? kManyEvents : kManyPhotons);
    // The truth, by a run that does not end by its error.
    SimulationOptions options;
    options.seed = 1'000'000;
    (events ? options.events : options.photons) = events ? 40'000 : 3'000'000;
    const Estimate truth =
        Simulation(scene_of(source), options).run_all().points.at(0).fraction(Fate::detected);
    double sum = 0.0, squares = 0.0, within_one = 0.0, within_two = 0.0;
    for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
      const tally::RunResult run =
          simulation_with(source + until(fmt::format("relative_error = {}", goal)), seed).run_all();
      REQUIRE(run.points.at(0).until->ended());
      const Estimate share = run.points.at(0).fraction(Fate::detected);
      sum += share.value;
      squares += share.value * share.value;
      const double pull = std::abs(share.value - truth.value) / share.error;
      within_one += pull < 1.0 ? 1.0 : 0.0;
      within_two += pull < 2.0 ? 1.0 : 0.0;
    }
    const auto runs = static_cast<double>(kRuns);
    const double mean = sum / runs, spread = std::sqrt((squares / runs - mean * mean) / runs);
    const double error = std::hypot(spread, truth.error);
    CAPTURE(mean / truth.value - 1.0);
    CAPTURE(error / truth.value);
    CHECK(std::abs(mean - truth.value) < kLimit * error + goal * goal * truth.value);
    // Coverage of 1 and 2 standard errors; a correct program fails each once in 16,000.
    CAPTURE(within_one / runs);
    CAPTURE(within_two / runs);
    for (const auto& [found, expected] : {std::pair{within_one / runs, 0.6827}, {within_two / runs, 0.9545}})
      CHECK(std::abs(found - expected) < kLimit * std::sqrt(expected * (1.0 - expected) / runs));
  }
}
#endif

TEST_CASE("The first condition that holds ends a point: photons, events, absolute error, time") {
  const auto point_of = [&](const std::string& scene) {
    return simulation_with(scene).run_all().points.at(0);
  };
  const tally::PointResult photons =
      point_of(dim_crystal() + kManyPhotons + until("relative_error = 0.0001, photons = 9_000"));
  CHECK(photons.emitted == 9 * 1024);
  CHECK(photons.complete);
  CHECK(photons.photons_requested == 100'000);
  REQUIRE(photons.until->conditions.size() == 2);
  CHECK_FALSE(photons.until->conditions[0].met);
  CHECK(photons.until->conditions[1].met);
  const tally::PointResult events = point_of(dim_crystal() + kManyEvents + until("events = 40"));
  CHECK(events.energy.events == 41);  // 32, 35, 38, 41
  const tally::PointResult escaped = point_of(
      dim_crystal() + kManyPhotons + until("absolute_error = 0.004, fate = \"absorbed_at_surface\""));
  CHECK(escaped.until->fate == Fate::absorbed_at_surface);
  CHECK(escaped.until->ended());
  CHECK(escaped.fraction(Fate::absorbed_at_surface).error <= 0.004);
  const tally::PointResult at_once = point_of(dim_crystal() + kManyPhotons + until("wall_time = \"1 ps\""));
  CHECK(at_once.emitted == 1024);
  CHECK_FALSE(at_once.until->is_reproducible());
  const tally::PointResult never = point_of(dim_crystal() + kManyPhotons + until("relative_error = 0.0001"));
  CHECK(never.emitted == 100'000);
  CHECK_FALSE(never.until->ended());
  CHECK(never.until->conditions.at(0).reached > 0.0001);
}

TEST_CASE("Why a run ended is in its file, and progress expects what is needed") {
  const auto path = scratch_folder("until_file") / "a.h5";
  ResultsFile file(path);
  SimulationHooks hooks;
  SimulationProgress last;
  hooks.progress = [&](const SimulationProgress& progress) { last = progress; };
  const tally::RunResult run =
      simulation_with(dim_crystal() + kManyPhotons + until("relative_error = 0.05, wall_time = \"3600 s\""))
          .run_all(file, hooks);
  const tally::PointResult read = results::read_results(path).points.at(0);
  REQUIRE(read.until);
  REQUIRE(read.until->conditions.size() == 2);
  CHECK(read.until->fate == Fate::detected);
  for (std::size_t i = 0; i < 2; ++i) {
    const tally::UntilCondition &a = read.until->conditions[i], &b = run.points.at(0).until->conditions[i];
    CHECK(a.quantity == b.quantity);
    CHECK(a.goal == b.goal);
    CHECK(a.reached == b.reached);
    CHECK(a.met == b.met);
  }
  CHECK(last.done == last.total);
  CHECK(last.done == run.points.at(0).emitted);
  CHECK(contains(last.error, "goal 5 %"));
}

TEST_CASE("A shard of a run that ends by its errors is refused, with the place of until") {
  const auto path = scratch_folder("until_shard") / "a.shard";
  RangeFile file(path, {1, 2});
  Simulation simulation = simulation_with(dim_crystal() + kManyPhotons + until("relative_error = 0.05"));
  try {
    simulation.run_all(file, {}, {1, 2});
    FAIL("a shard was traced");
  } catch (const InputError& error) {
    CHECK(contains(error.problems().front().what, "until"));
    CHECK(contains(error.problems().front().hint, "--shard"));
    CHECK(error.problems().front().where.line > 0);
  }
}
