// The bias of runs that end by the error of a tally's bin, a photopeak, a CTR and other results of events.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <string>

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
energy = "60 keV"
)";

/// A result by which runs end.
struct EndingGoal {
  std::string of;
  std::string condition;
  bool events = false;
  double goal = 0.0;  ///< relative error at the end
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

Estimate run_of(const EndingGoal& goal, const std::string& more, const SimulationOptions& options) {
  MemorySink sink;
  Simulation(scene_of((goal.events ? painted_crystal(0.95) + kLitEvents : painted_crystal(0.5) + kLitPhotons) +
                      more),
             options)
      .run_all(sink);
  if (!more.empty()) REQUIRE(sink.result.points.at(0).until->ended());
  return result_of(goal, sink);
}

}  // namespace

TEST_CASE("Ending by the error of a tally's bin, a photopeak or a CTR has no bias above its square") {
  constexpr double kLimit = 4.0;  // a correct program fails each number once in 16,000
  constexpr std::uint64_t kRuns = 200;
  const std::vector<EndingGoal> goals = {
      {"tally", "tally = \"when\", bin = [\"60 ns\"], relative_error = 0.05", false, 0.05},
      {"photopeak", "relative_error = 0.02", true, 0.02},
      {"light_per_energy", "relative_error = 0.02", true, 0.02},
      {"energy_resolution", "relative_error = 0.08", true, 0.08},
      {"ctr", "relative_error = 0.06", true, 0.06}};
  for (const EndingGoal& goal : goals) {
    CAPTURE(goal.of);
    SimulationOptions options;
    options.threads = 2;
    options.seed = 1'000'000;
    (goal.events ? options.events : options.photons) = goal.events ? 20'000 : 3'000'000;
    const Estimate truth = run_of(goal, "", options);
    double sum = 0.0, squares = 0.0, pulls = 0.0, within_one = 0.0, within_two = 0.0;
    options.events = options.photons = std::nullopt;
    for (options.seed = 1; *options.seed <= kRuns; ++*options.seed) {
      const Estimate ended = run_of(
          goal, fmt::format("[run]\nuntil = {{ of = \"{}\", {} }}\n", goal.of, goal.condition), options);
      sum += ended.value;
      squares += ended.value * ended.value;
      const double pull = (ended.value - truth.value) / std::hypot(ended.error, truth.error);
      pulls += pull * pull;
      within_one += std::abs(pull) < 1.0 ? 1.0 : 0.0;
      within_two += std::abs(pull) < 2.0 ? 1.0 : 0.0;
    }
    const auto runs = static_cast<double>(kRuns);
    const double mean = sum / runs, spread = std::sqrt((squares / runs - mean * mean) / runs);
    const double error = std::hypot(spread, truth.error);
    CAPTURE(mean / truth.value - 1.0);
    CAPTURE(error / truth.value);
    MESSAGE(goal.of << " bias " << mean / truth.value - 1.0 << " +- " << error / truth.value << " goal^2 " << goal.goal * goal.goal << " rms pull " << std::sqrt(pulls / runs) << " cov " << within_one / runs << " " << within_two / runs << " truth " << truth.value << " " << truth.error);
    CHECK(std::abs(mean - truth.value) < kLimit * error + goal.goal * goal.goal * truth.value);
    CAPTURE(within_one / runs);
    CAPTURE(within_two / runs);
    for (const auto& [found, expected] : {std::pair{within_one / runs, 0.6827}, {within_two / runs, 0.9545}})
      CHECK(std::abs(found - expected) < kLimit * std::sqrt(expected * (1.0 - expected) / runs));
  }
}
#endif
