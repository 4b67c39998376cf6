// Scenes that never were a file.
#include <doctest/doctest.h>

#include <cstring>

#include "scenes.hpp"
#include "scintray/simulation/memory_sink.hpp"
#include "scintray/simulation/simulation.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene_file;
using namespace scintray::tally;
using namespace scintray::simulation;
using namespace scintray::test;

namespace {

/// Stands on z = 0, as box = [x, y, z] does in a file.
BoxSpec box(double x_mm, double y_mm, double z_mm) {
  BoxSpec result;
  result.low = {-0.5 * x_mm, -0.5 * y_mm, 0.0};
  result.high = {0.5 * x_mm, 0.5 * y_mm, z_mm};
  return result;
}

/// kCrystal with kPhotons, in code.
SceneSpec crystal_in_code() {
  SceneSpec scene;
  scene.title = "A crystal";
  scene.ambient = {"air", {}};
  PartSpec crystal;
  crystal.name = {"crystal", {}};
  crystal.shape = box(2.0, 2.0, 4.0);
  crystal.medium = {"LSO", {}};
  crystal.surface = {"polished", {}};
  PartSpec sensor;
  sensor.name = {"pmt", {}};
  sensor.shape = box(2.0, 2.0, 1.0);
  sensor.placement.touch = TouchSpec{{"crystal", {}}, {2, -1}, 0.0, {}, {}};
  sensor.sensor = {"R6231", {}};
  scene.parts = {crystal, sensor};
  RegionSpec region;
  region.part = {"crystal", {}};
  scene.source.origin = region;
  scene.source.time_ns.reset();
  scene.source.photons = 3'000;
  scene.source.photons_per_event = 100;
  return scene;
}

bool same_bits(const Moments& a, const Moments& b) {
  return a.count == b.count && std::memcmp(&a.sum, &b.sum, sizeof a.sum) == 0 &&
         std::memcmp(&a.sum_of_squares, &b.sum_of_squares, sizeof a.sum_of_squares) == 0;
}

}  // namespace

TEST_CASE("A scene made of structs has the numbers of the same scene's file, to the last bit") {
  Simulation from_file(scene_of(kCrystal + kPhotons)), in_code(crystal_in_code());
  CHECK(in_code.points() == 1);
  CHECK(in_code.parameters(0).empty());
  const PointResult a = from_file.run(0), b = in_code.run(0);
  CHECK(a.complete);
  CHECK(a.emitted == 3'000);
  CHECK(a.count(Fate::detected) > 100);
  CHECK(a.fates == b.fates);
  CHECK(a.absorbed_in_medium == b.absorbed_in_medium);
  CHECK(a.absorbed_at_surface == b.absorbed_at_surface);
  CHECK(a.segments == b.segments);
  CHECK(same_bits(a.interactions, b.interactions));
  CHECK(same_bits(a.detected_path_mm, b.detected_path_mm));
  CHECK(same_bits(a.detected_time_ns, b.detected_time_ns));
  CHECK(in_code.header().parts == from_file.header().parts);
  CHECK(in_code.header().surfaces == from_file.header().surfaces);
  CHECK(in_code.header().scene_file.empty());
  CHECK(in_code.header().scene_text.empty());
}

TEST_CASE("Mistakes in a scene made of structs are reported without a place in a file") {
  SceneSpec scene = crystal_in_code();
  scene.parts[0].medium = {"LSOO", {}};
  Simulation simulation(scene);
  try {
    simulation.run(0);
    FAIL("no error");
  } catch (const InputError& error) {
    REQUIRE_FALSE(error.problems().empty());
    CHECK(error.problems()[0].where.file.empty());
    CHECK(error.problems()[0].what.find("LSOO") != std::string::npos);
  }
}

TEST_CASE("Options replace the settings of the scene") {
  SimulationOptions options;
  options.photons = 500;
  options.seed = 9;
  options.threads = 1;
  options.change = [](SceneSpec& scene) { scene.title += ", changed"; };
  Simulation simulation(crystal_in_code(), options);
  const RunResult result = simulation.run_all();
  CHECK(result.header.seed == 9);
  CHECK(result.header.title == "A crystal, changed");
  CHECK(result.points.at(0).emitted == 500);
  CHECK(simulation.spec(0).run.threads == 1);
  options.events = 3;
  CHECK_THROWS_AS(Simulation(crystal_in_code(), options).run(0), InputError);
}

TEST_CASE("A results file is not needed for events either") {
  SceneSpec scene = scene_of(kCrystal + kEvents).spec(0);
  scene.file.clear();
  scene.folder.clear();
  scene.text.clear();
  MemorySink memory;
  const RunResult result = Simulation(scene).run_all(memory);
  CHECK(result.points.at(0).energy.events == 12);
  REQUIRE(memory.event_list.size() == 12);
  CHECK(memory.readouts.at(0).channels.at(0).name == "pmt");
  for (const EventRecord& event : memory.event_list) CHECK(event.channels.at(0).detected == event.detected);
}
