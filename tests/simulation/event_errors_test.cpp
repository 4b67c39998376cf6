// Errors of fates and tallies of event sources: the photons of one event share its place, so that they are
// not independent.
#include <doctest/doctest.h>

#include <cmath>
#include <numeric>

#include "scenes.hpp"
#include "scintray/analysis/light_analysis.hpp"
#include "scintray/scene/build_scene.hpp"
#include "scintray/simulation/memory_sink.hpp"
#include "scintray/simulation/results_file.hpp"
#include "scintray/simulation/simulation.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::simulation;
using namespace scintray::test;

namespace {

/// Black but for the face at the sensor: the share of an event that is detected is the solid angle of that
/// face at its place.
std::string black_crystal() {
  return painted_crystal(0.0) + R"(
[source]
type = "gamma_events"
events = 60
region = { part = "crystal" }
energy = "8 keV"
)";
}
const std::string kTallies = R"(
[[tally]]
type = "count"
name = "depth"
at = "absorbed_at_surface"
axes = [{ variable = "position", along = [0, 0, 1], from = "0 mm", to = "4 mm", bins = 2 }]
[[tally]]
type = "count"
name = "path"
at = "detected"
score = "path"
)";
/// From several bins of which light spread, divergence, etendue and crosstalk are computed.
const std::string kLightTallies = R"(
[[tally]]
type = "light_spread"
name = "light"
face = "crystal:exit"
pixels = [8, 8]
[[tally]]
type = "exit_angle"
face = "crystal:exit"
bins = 90
[[tally]]
type = "etendue"
name = "etendue"
face = "crystal:exit"
pixels = [2, 2]
polar_bins = 4
azimuth_bins = 4
[[tally]]
type = "crosstalk"
name = "matrix"
)";

/// Results of runs that differ in their seeds alone.
std::vector<tally::PointResult> runs_of(const std::string& scene, std::uint64_t count) {
  materials::SurfaceFactory::Hooks hooks;
  hooks.cache.clear();
  scene::SceneBuilder builder(hooks);
  scene_file::SceneSpec spec = scene_of(scene).spec(0);
  const auto built = std::make_shared<const scene::BuiltScene>(builder.build(spec));
  std::vector<tally::PointResult> results;
  for (spec.run.seed = 1; spec.run.seed <= count; ++spec.run.seed)
    results.push_back(SimulationPoint(spec, built).trace());
  return results;
}

/// Of the values of many runs, their distances from the value of all together, in their errors.
struct Pulls {
  double count = 0.0, mean = 0.0, mean_square = 0.0, mean_fourth = 0.0;

  Pulls(const std::vector<Estimate>& values, double truth) : count(static_cast<double>(values.size())) {
    for (const Estimate& value : values) {
      const double pull = (value.value - truth) / value.error;
      mean += pull / count;
      mean_square += pull * pull / count;
      mean_fourth += std::pow(pull, 4) / count;
    }
  }
  double width() const { return std::sqrt(mean_square - mean * mean); }
  /// True when mean 0 and mean square 1 + 2 / (events - 3), the variance of Student's distribution, are
  /// within four standard errors, by the spread of the pulls themselves: a correct program fails once in
  /// 8000.
  bool are_standard(double events) const {
    constexpr double kLimit = 4.0;
    const double expected = (events - 1.0) / (events - 3.0);
    const double spread = std::sqrt((mean_fourth - mean_square * mean_square) / count);
    return std::abs(mean) < kLimit * std::sqrt(mean_square / count) &&
           std::abs(mean_square - expected) < kLimit * spread;
  }
};

constexpr std::uint64_t kRuns = 300;
constexpr double kEventsOfARun = 60.0;

/// The ratio of the sums of two numbers over all runs.
template <typename Over, typename Under>
double ratio_of_all(const std::vector<tally::PointResult>& runs, const Over& over, const Under& under) {
  double y = 0.0, x = 0.0;
  for (const tally::PointResult& run : runs) {
    y += over(run);
    x += under(run);
  }
  return y / x;
}

}  // namespace

TEST_CASE(
    "The fates of an event source have pulls of mean 0 and width 1, with and without a birth efficiency") {
  for (const bool birth : {true, false}) {
    const auto runs = runs_of(black_crystal() + (birth ? "" : "[run]\nefficiency_at_birth = false\n"), kRuns);
    CHECK((runs.front().birth_efficiency < 1.0) == birth);
    for (const Fate fate : {Fate::detected, Fate::not_detected, Fate::absorbed_at_surface}) {
      CAPTURE(fate_name(fate));
      const double truth = ratio_of_all(
          runs,
          [&](const tally::PointResult& run) {
            return run.fraction(fate).value * static_cast<double>(run.photons);
          },
          [](const tally::PointResult& run) { return static_cast<double>(run.photons); });
      std::vector<Estimate> values, as_independent;
      for (const tally::PointResult& run : runs) {
        values.push_back(run.fraction(fate));
        tally::PointResult photons = run;
        photons.event_fates = {};
        as_independent.push_back(photons.fraction(fate));
      }
      const Pulls pulls(values, truth), before(as_independent, truth);
      CAPTURE(pulls.mean);
      CAPTURE(pulls.width());
      CHECK(pulls.are_standard(kEventsOfARun));
      // As independent photons the same numbers fail.
      CAPTURE(before.width());
      CHECK_FALSE(before.are_standard(kEventsOfARun));
    }
  }
}

TEST_CASE("The bins of tallies of an event source have pulls of mean 0 and width 1, summed and per photon") {
  const auto runs = runs_of(black_crystal() + kTallies, 2 * kRuns);  // independent photons are wrong by 1.2
  for (const auto& place : {std::pair{0, 0}, {0, 1}, {1, 0}}) {
    const int tally = place.first, bin = place.second;
    CAPTURE(tally);
    CAPTURE(bin);
    const auto number = static_cast<std::size_t>(tally);
    const auto at = static_cast<std::size_t>(bin);
    const auto sum = [&](const tally::PointResult& run) { return run.tallies.at(number).sum.at(at); };
    std::vector<Estimate> sums, shares, as_independent;
    for (const tally::PointResult& run : runs) {
      const tally::TallyResult& result = run.tallies.at(number);
      sums.push_back(result.at(at, run.photons));
      shares.push_back(result.per_photon(at, run.photons));
      tally::TallyResult photons = result;
      photons.event_squares.clear();
      as_independent.push_back(photons.at(at, run.photons));
    }
    const double mean = ratio_of_all(runs, sum, [](const tally::PointResult&) { return 1.0; });
    const double share = ratio_of_all(
        runs, sum, [](const tally::PointResult& run) { return static_cast<double>(run.photons); });
    const Pulls pulls(sums, mean), of_shares(shares, share), before(as_independent, mean);
    CAPTURE(pulls.mean);
    CAPTURE(pulls.width());
    CAPTURE(of_shares.width());
    CAPTURE(before.width());
    CHECK(pulls.are_standard(kEventsOfARun));
    CHECK(of_shares.are_standard(kEventsOfARun));
    CHECK_FALSE(before.are_standard(kEventsOfARun));
  }
}

TEST_CASE(
    "Shares of a surface and of a sensor's face have pulls of mean 0 and width 1 with an event source") {
  for (const bool birth : {true, false}) {
    const auto runs = runs_of(black_crystal() + (birth ? "" : "[run]\nefficiency_at_birth = false\n"), kRuns);
    const auto at_surface = [](const tally::PointResult& run) {
      SurfaceId most(0);
      for (const SurfaceId surface : run.absorbed_at_surface.ids())
        if (run.absorbed_at_surface[surface] > run.absorbed_at_surface[most]) most = surface;
      return run.absorbed_fraction(most);
    };
    const auto detected = [](const tally::PointResult& run) {
      return run.detected_fraction(run.sensor_faces.at(0));
    };
    const auto not_detected = [](const tally::PointResult& run) {
      return run.not_detected_fraction(run.sensor_faces.at(0));
    };
    REQUIRE(runs.front().sensor_faces.size() == 1);
    const auto check = [&](const auto& share_in) {
      const double truth = ratio_of_all(
          runs,
          [&](const tally::PointResult& run) {
            return share_in(run).value * static_cast<double>(run.photons);
          },
          [](const tally::PointResult& run) { return static_cast<double>(run.photons); });
      std::vector<Estimate> values, as_independent;
      for (const tally::PointResult& run : runs) {
        values.push_back(share_in(run));
        tally::PointResult photons = run;
        photons.event_fates = {};
        as_independent.push_back(share_in(photons));
      }
      const Pulls pulls(values, truth), before(as_independent, truth);
      CAPTURE(pulls.width());
      CAPTURE(before.width());
      CHECK(pulls.are_standard(kEventsOfARun));
      CHECK_FALSE(before.are_standard(kEventsOfARun));
    };
    check(at_surface);
    check(detected);
    check(not_detected);
  }
}

TEST_CASE("Means of time, path and interactions have pulls of mean 0 and width 1 with an event source") {
  const auto runs = runs_of(black_crystal(), kRuns);
  for (const auto member : {&tally::PointResult::detected_path_mm, &tally::PointResult::detected_time_ns,
                            &tally::PointResult::interactions}) {
    const double truth = ratio_of_all(
        runs, [&](const tally::PointResult& run) { return (run.*member).sum; },
        [&](const tally::PointResult& run) { return static_cast<double>((run.*member).count); });
    std::vector<Estimate> values, as_independent;
    for (const tally::PointResult& run : runs) {
      values.push_back((run.*member).mean());
      as_independent.push_back((run.*member).Moments::mean());
    }
    const Pulls pulls(values, truth), before(as_independent, truth);
    CAPTURE(pulls.mean);
    CAPTURE(pulls.width());
    CAPTURE(before.width());
    CHECK(pulls.are_standard(kEventsOfARun));
    // The number of interactions of a photon, and its time, most of which is that of its emission, hardly
    // depend on the place of its event.
    if (member == &tally::PointResult::detected_path_mm) CHECK_FALSE(before.are_standard(kEventsOfARun));
  }
}

TEST_CASE("What is computed from several bins has pulls of mean 0 and width 1 with an event source") {
  const auto runs = runs_of(black_crystal() + kLightTallies, kRuns);
  using Read = Estimate (*)(const tally::PointResult&);
  struct Result {
    const char* name;
    Read read;
  };
  const Result results[] = {
      {"centre of light",
       [](const tally::PointResult& run) -> Estimate {
         const analysis::LightSpread spread = analysis::light_spread(analysis::find_tally(run, "light"));
         return {spread.centre_mm[0], spread.centre_error_mm[0]};
       }},
      {"half-angle of half of the light",
       [](const tally::PointResult& run) {
         const analysis::CrossingAngles angles = analysis::crossing_angles(run).at(0);
         return analysis::divergence(angles.inside, angles.inside_groups).half_rad;
       }},
      {"mean cosine",
       [](const tally::PointResult& run) {
         const analysis::CrossingAngles angles = analysis::crossing_angles(run).at(0);
         return analysis::divergence(angles.outside, angles.outside_groups).mean_cosine;
       }},
      {"etendue",
       [](const tally::PointResult& run) {
         return analysis::read_etendue(analysis::find_tally(run, "etendue")).filled_mm2_sr;
       }},
      {"share of the light of the crystal that the sensor detects", [](const tally::PointResult& run) {
         const analysis::Crosstalk crosstalk = analysis::read_crosstalk(run, "matrix");
         Estimate most{};
         for (const auto& row : crosstalk.share)
           for (const Estimate& share : row) most = share.value > most.value ? share : most;
         return most;
       }}};
  for (const Result& result : results) {
    CAPTURE(result.name);
    std::vector<Estimate> values, as_independent;
    double truth = 0.0;
    for (const tally::PointResult& run : runs) {
      values.push_back(result.read(run));
      truth += values.back().value / static_cast<double>(runs.size());
      tally::PointResult photons = run;
      for (tally::TallyResult& tally : photons.tallies) tally.group_sums.clear();
      as_independent.push_back(result.read(photons));
    }
    const Pulls pulls(values, truth), before(as_independent, truth);
    CAPTURE(pulls.mean);
    CAPTURE(pulls.width());
    CAPTURE(before.width());
    CHECK(pulls.are_standard(kEventsOfARun));
    CHECK_FALSE(before.are_standard(kEventsOfARun));
  }
}

TEST_CASE("Sums over events are those of the events, in memory, in shards and in the file") {
  const scene_file::SceneFile scene = scene_of(black_crystal() + kTallies + kLightTallies);
  const std::filesystem::path folder = scratch_folder("event_errors");
  MemorySink memory;
  ResultsFile file(folder / "a.h5");
  Simulation(scene).run_all(memory);
  Simulation(scene).run_all(file);
  const tally::PointResult& point = memory.result.points.at(0);
  std::uint64_t squares = 0, events = 0;
  for (const tally::EventRecord& event : memory.event_list) {
    squares += event.detected * event.detected;
    events += event.emitted > 0 ? 1 : 0;
  }
  const std::size_t detected = fate_index(Fate::detected);
  CHECK(point.event_fates.products[detected][detected] == squares);
  CHECK(point.event_fates.events == events);
  double photons = 0.0;
  for (const tally::EventRecord& event : memory.event_list)
    photons += std::pow(static_cast<double>(event.emitted), 2);
  CHECK(point.event_fates.photon_squares() == photons);

  std::vector<std::filesystem::path> shards;
  for (const std::uint64_t number : {2, 3, 1}) {
    shards.push_back(folder / (std::to_string(number) + ".shard"));
    RangeFile shard(shards.back(), {number, 3});
    Simulation(scene).run_all(shard, {}, {number, 3});
  }
  MemorySink merged;
  merge_ranges(shards, merged);
  for (const tally::PointResult& other :
       {merged.result.points.at(0), results::read_results(folder / "a.h5").points.at(0)}) {
    CHECK(other.event_fates == point.event_fates);
    CHECK(other.events_in_medium.values() == point.events_in_medium.values());
    CHECK(other.events_at_surface.values() == point.events_at_surface.values());
    REQUIRE(other.sensor_faces.size() == point.sensor_faces.size());
    for (std::size_t face = 0; face < point.sensor_faces.size(); ++face) {
      CHECK(other.sensor_faces[face].events_detected == point.sensor_faces[face].events_detected);
      CHECK(other.sensor_faces[face].events_not_detected == point.sensor_faces[face].events_not_detected);
      CHECK(other.sensor_faces[face].events_both == point.sensor_faces[face].events_both);
    }
    CHECK(other.interactions.of_events == point.interactions.of_events);
    CHECK(other.detected_path_mm.of_events == point.detected_path_mm.of_events);
    CHECK(other.detected_time_ns.of_events == point.detected_time_ns.of_events);
    CHECK(other.detected_interactions.of_events == point.detected_interactions.of_events);
    for (const char* const tally : {"light", "etendue", "matrix", "matrix: emitted"}) {
      const std::vector<double>& sums = analysis::find_tally(point, tally).group_sums;
      CHECK(analysis::find_tally(other, tally).group_sums == sums);
      CHECK(std::accumulate(sums.begin(), sums.end(), 0.0) > 0.0);
    }
    CHECK(analysis::crossing_angles(other).at(0).inside_groups ==
          analysis::crossing_angles(point).at(0).inside_groups);
    CHECK(analysis::crossing_angles(other).at(0).outside_groups ==
          analysis::crossing_angles(point).at(0).outside_groups);
    for (const std::size_t tally : {0, 1}) {
      CHECK(other.tallies.at(tally).event_squares == point.tallies.at(tally).event_squares);
      CHECK(other.tallies.at(tally).event_products == point.tallies.at(tally).event_products);
      CHECK(other.tallies.at(tally).at(0, other.photons).error ==
            point.tallies.at(tally).at(0, point.photons).error);
    }
  }
}

TEST_CASE("A source of photons has no sums over events") {
  const tally::RunResult run = Simulation(scene_of(kCrystal + kPhotons + kTallies)).run_all();
  CHECK(run.points.at(0).event_fates == tally::EventFates{});
  CHECK(run.points.at(0).tallies.at(0).event_squares.empty());
  CHECK(run.points.at(0).interactions.of_events == tally::EventMoments{});
  const Estimate share = run.points.at(0).fraction(Fate::escaped);
  CHECK(share.error == binomial_estimate(run.points.at(0).count(Fate::escaped), 3000).error);
}
