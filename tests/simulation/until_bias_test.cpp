// The bias of runs that end by the error of a tally's bin, a photopeak, a CTR and other results of events.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "scenes.hpp"
#include "scintray/simulation/analyze_results.hpp"
#include "scintray/simulation/memory_sink.hpp"
#include "scintray/simulation/simulation.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::simulation;
using namespace scintray::test;

#ifndef SCINTRAY_SANITIZED
namespace {

const char* const kLitPhotons = R"(
[source]
type = "photons"
region = { part = "crystal" }
wavelength = "emission"
time = "decay"
photons = 200_000
[[tally]]
type = "count"
name = "when"
at = "detected"
part = "pmt"
axes = [{ variable = "time", from = "0 ns", to = "200 ns", bins = 4 }]
)";
const char* const kLitEvents = R"(
[source]
type = "gamma_events"
events = 20_000
region = { part = "crystal" }
energy = "20 keV"
)";

/// A result by which runs end.
struct EndingGoal {
  std::string of;
  std::string condition;
  bool events = false;
  double goal = 0.0;  ///< relative error at the end
  std::uint64_t runs = 0;
};

/// The result of a run of one point, by the analysis of all of it.
Estimate result_of(const EndingGoal& goal, const MemorySink& sink) {
  const tally::PointResult& point = sink.result.points.at(0);
  if (!goal.events) {
    const Estimate score = point.tallies.at(0).per_photon(1, point.photons);
    return {point.birth_efficiency * score.value, point.birth_efficiency * score.error};
  }
  const analysis::EventAnalysis all = analysis::analyze_events(
      sink.event_list, analysis_setup({}, sink.readouts.at(0).channels, sink.result.header.parts));
  if (goal.of == "photopeak") return all.peak.fit.position;
  if (goal.of == "energy_resolution") return all.peak.fit.relative_fwhm;
  if (goal.of == "light_per_energy") return all.light_per_keV;
  return analysis::quoted_fwhm(all.pair_difference_ns.value());
}

void run_into(MemorySink& sink, bool events, const std::string& more, const SimulationOptions& options) {
  Simulation(
      scene_of((events ? painted_crystal(0.95) + kLitEvents : painted_crystal(0.5) + kLitPhotons) + more),
      options)
      .run_all(sink);
}

}  // namespace

TEST_CASE("Ending by the error of a tally's bin, a photopeak or a CTR has no bias above its square") {
  constexpr double kLimit = 4.0;  // a correct program fails each number once in 16,000
  const std::vector<EndingGoal> goals = {
      {"tally", "tally = \"when\", bin = [\"60 ns\"], relative_error = 0.05", false, 0.05, 100},
      {"photopeak", "relative_error = 0.02", true, 0.02, 40},
      {"ctr", "relative_error = 0.12", true, 0.12, 40}};
  SimulationOptions options;
  options.threads = 2;
  options.seed = 1'000'000;
  options.events = 6'000;
  MemorySink many_photons, many_events;
  run_into(many_events, true, "", options);
  options.events = std::nullopt;
  options.photons = 3'000'000;
  run_into(many_photons, false, "", options);
  options.photons = std::nullopt;
  for (const EndingGoal& goal : goals) {
    CAPTURE(goal.of);
    const Estimate truth = result_of(goal, goal.events ? many_events : many_photons);
    double sum = 0.0, squares = 0.0, within_one = 0.0, within_two = 0.0;
    for (options.seed = 1; *options.seed <= goal.runs; ++*options.seed) {
      MemorySink sink;
      run_into(sink, goal.events,
               fmt::format("[run]\nuntil = {{ of = \"{}\", {} }}\n", goal.of, goal.condition), options);
      if (!sink.result.points.at(0).until->ended()) FAIL("a run that did not end by its error");
      const Estimate ended = result_of(goal, sink);
      sum += ended.value;
      squares += ended.value * ended.value;
      const double pull = (ended.value - truth.value) / std::hypot(ended.error, truth.error);
      within_one += std::abs(pull) < 1.0 ? 1.0 : 0.0;
      within_two += std::abs(pull) < 2.0 ? 1.0 : 0.0;
    }
    const auto runs = static_cast<double>(goal.runs);
    const double mean = sum / runs, spread = std::sqrt((squares / runs - mean * mean) / runs);
    const double error = std::hypot(spread, truth.error);
    CAPTURE(mean / truth.value - 1.0);
    CAPTURE(error / truth.value);
    CHECK(std::abs(mean - truth.value) < kLimit * error + goal.goal * goal.goal * truth.value);
    CAPTURE(within_one / runs);
    CAPTURE(within_two / runs);
    for (const auto& [found, expected] : {std::pair{within_one / runs, 0.6827}, {within_two / runs, 0.9545}})
      CHECK(std::abs(found - expected) < kLimit * std::sqrt(expected * (1.0 - expected) / runs));
  }
}
#endif
