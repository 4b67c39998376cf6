// The same run in a file and in memory, and its photons followed again.
#include <doctest/doctest.h>

#include "scenes.hpp"
#include "scintray/simulation/memory_sink.hpp"
#include "scintray/simulation/results_file.hpp"
#include "scintray/simulation/simulation.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene_file;
using namespace scintray::source;
using namespace scintray::transport;
using namespace scintray::tally;
using namespace scintray::results;
using namespace scintray::simulation;
using namespace scintray::test;

namespace {

const std::string kLists = "[run]\nseed = 3\nphoton_list = true\nphoton_history = true\n";
const std::string kReadout = R"(
[readout]
period = "0.5 ns"
before = "5 ns"
window = "200 ns"
shaping = { order = 1, time_constant = "5 ns" }
threshold = 3
)";

void check_same(const RunResult& a, const RunResult& b) {
  CHECK(a.header.parts == b.header.parts);
  CHECK(a.header.faces == b.header.faces);
  CHECK(a.header.media == b.header.media);
  CHECK(a.header.surfaces == b.header.surfaces);
  CHECK(a.header.note == b.header.note);
  CHECK(a.header.seed == b.header.seed);
  CHECK(a.complete() == b.complete());
  REQUIRE(a.points.size() == b.points.size());
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    CHECK(a.points[i].parameters == b.points[i].parameters);
    CHECK(a.points[i].fates == b.points[i].fates);
    CHECK(a.points[i].absorbed_at_surface == b.points[i].absorbed_at_surface);
    CHECK(a.points[i].segments == b.points[i].segments);
    CHECK(a.points[i].detected_time_ns.sum == b.points[i].detected_time_ns.sum);
    CHECK(a.points[i].energy.events == b.points[i].energy.events);
  }
}

}  // namespace

TEST_CASE("A file, the memory and what run_all returns hold the same photons") {
  const SceneFile scene = scene_of(kCrystal + kPhotons + kLists + kSurfaceSweep);
  const auto path = scratch_folder("simulation_sinks") / "photons.h5";
  ResultsFile file(path);
  MemorySink memory;
  const RunResult returned = Simulation(scene).run_all(file);
  Simulation(scene).run_all(memory);
  check_same(returned, memory.result);
  check_same(returned, read_results(path));
  CHECK(memory.outline.photon_list);
  REQUIRE(memory.outline.histories);

  const std::vector<DetectedPhoton> listed = read_photons(path, 0, 100'000);
  REQUIRE(listed.size() == memory.photon_list.size());
  REQUIRE(listed.size() > 500);
  for (std::size_t i = 0; i < listed.size(); ++i) {
    CHECK(listed[i].point == memory.photon_list[i].point);
    CHECK(listed[i].photon == memory.photon_list[i].photon);
    CHECK(listed[i].face == memory.photon_list[i].face);
    CHECK(listed[i].time_ns == memory.photon_list[i].time_ns);
    CHECK(listed[i].position_mm == memory.photon_list[i].position_mm);
  }
  const HistoryReader histories(path);
  CHECK(histories.columns().media == memory.outline.histories->media);
  std::size_t rows = 0;
  for (const MemorySink::PointHistories& point : memory.history_list) rows += point.rows.rows();
  CHECK(rows == histories.rows());
  CHECK(rows == listed.size());
  CHECK(memory.history_list.size() == 3);
}

TEST_CASE("A file and the memory hold the same events") {
  const SceneFile scene = scene_of(kCrystal + kEvents + kReadout);
  const auto path = scratch_folder("simulation_sinks_events") / "events.h5";
  ResultsFile file(path);
  MemorySink memory;
  Simulation(scene).run_all(file);
  Simulation(scene).run_all(memory);
  check_same(read_results(path), memory.result);
  const std::vector<EventRecord> events = read_events(path, 0, 100);
  REQUIRE(events.size() == memory.event_list.size());
  REQUIRE(events.size() == 12);
  for (std::size_t i = 0; i < events.size(); ++i) {
    CHECK(events[i].emitted == memory.event_list[i].emitted);
    CHECK(events[i].channels.at(0).charge == memory.event_list[i].channels.at(0).charge);
    CHECK(events[i].channels.at(0).time_ns == memory.event_list[i].channels.at(0).time_ns);
  }
  CHECK(memory.readouts.at(0).channels.at(0).name == read_channels(path, 0).at(0).name);
  CHECK(memory.result.points.at(0).light_timing.has_value() ==
        read_results(path).points.at(0).light_timing.has_value());
}

TEST_CASE("A point alone has the same result as in the run of all points") {
  const SceneFile scene = scene_of(kCrystal + kPhotons + kSurfaceSweep);
  Simulation all(scene), alone(scene);
  const RunResult together = all.run_all();
  const PointResult last = alone.run(2);
  CHECK(last.fates == together.points[2].fates);
  CHECK(last.absorbed_at_surface == together.points[2].absorbed_at_surface);
  CHECK(last.parameters == together.points[2].parameters);
  CHECK(last.detected_time_ns.sum == together.points[2].detected_time_ns.sum);
}

TEST_CASE("Replay follows the photon that the run detected, with the run's own seed, limits and streams") {
  SimulationOptions options;
  options.seed = 77;
  options.change = [](SceneSpec& spec) { spec.run.max_time_ns = 60.0; };
  Simulation simulation(scene_of(kCrystal + kPhotons + kLists + kSurfaceSweep), options);
  MemorySink memory;
  simulation.run_all(memory);
  REQUIRE(memory.result.points[1].count(Fate::cut_time) > 100);
  std::size_t followed = 0;
  for (const DetectedPhoton& photon : memory.photon_list) {
    if (photon.point != 1 || photon.photon % 5 != 0) continue;
    Step last;
    const Photon end = simulation.replay(1, photon.event, photon.photon,
                                         [&](const Photon&, const Step& step) { last = step; });
    CHECK(last.event == StepEvent::detected);
    CHECK(static_cast<float>(end.path_mm) == photon.path_mm);
    CHECK(static_cast<float>(end.time_ns) == photon.time_ns);
    CHECK(end.interactions == photon.interactions);
    ++followed;
  }
  CHECK(followed > 20);
  CHECK_THROWS_AS(simulation.replay(1, 0, 100, [](const Photon&, const Step&) {}), InputError);
}

TEST_CASE("A result states the effects that it does not include, of its media, sensors and electronics") {
  const auto names = [](const PointResult& point) {
    std::string list;
    REQUIRE(point.omitted);
    for (const OmittedEffect& effect : *point.omitted)
      list += effect.effect + "|" + effect.subject + "|" + (effect.in_resolution ? "R" : "") +
              (effect.in_timing ? "T" : "") + (effect.in_fraction ? "F" : "") + "\n";
    return list;
  };
  const auto traced = [](const std::string& text) {
    Simulation simulation(scene_of(text));
    return simulation.run_all().points.at(0);
  };
  const std::string photons = names(traced(kCrystal + kPhotons));
  check_contains(photons, "reflection behind the sensor's window, back into the detector|R6231|F\n");
  check_contains(photons, "dependence of the efficiency on angle|R6231|F\n");
  CHECK_FALSE(contains(photons, "resolution"));  // there are no events

  const std::string events = names(traced(kCrystal + kEvents));
  check_contains(events, "non-proportionality|LSO|R\n");
  CHECK_FALSE(contains(events, "intrinsic resolution"));
  std::string iodide = kCrystal + kEvents;
  iodide.replace(iodide.find("\"LSO\""), 5, "\"NaI_Tl\"");
  check_contains(names(traced(iodide)), "intrinsic resolution|NaI_Tl|R\n");
  check_contains(events, "|RT\n");
  check_contains(events, "electronics and response of the sensors");
  CHECK_FALSE(contains(events, "electronic noise"));

  const std::string readout = R"(
[readout]
before = "0 ns"
window = "200 ns"
shaping = { order = 1, time_constant = "4 ns" }
sampling = "1 GHz"
time_pickoff = "leading_edge"
threshold = 0.5
)";
  const std::string read_out = names(traced(kCrystal + kEvents + readout));
  for (const char* line :
       {"electronic noise||RT\n", "time spread of single photons|R6231|T\n", "charge spread|R6231|RT\n",
        "crosstalk, if it is a SiPM|R6231|RT\n", "dark counts|R6231|RT\n"})
    check_contains(read_out, line);
  CHECK_FALSE(contains(read_out, "electronics and response"));

  // What is stated is not listed, and a sensor that detects all light reflects none.
  std::string full = kCrystal + kEvents + readout + R"(noise = 0.1
[sensors.tube]
base = "R6231"
transit_time = { sigma = "0.3 ns" }
single_electron = { charge_spread = 0.4 }
dark_counts = { rate = "1 kHz" }
)";
  full.replace(full.find("sensor = \"R6231\""), 16, "sensor = \"tube\"");
  const std::string stated = names(traced(full));
  for (const char* effect : {"time spread", "charge spread", "dark counts", "electronic noise"})
    CHECK_FALSE(contains(stated, effect));
  std::string ideal = kCrystal + kPhotons;
  ideal.replace(ideal.find("R6231"), 5, "ideal");
  CHECK(names(traced(ideal)).empty());
}
