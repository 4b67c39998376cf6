// How often scenes are built and definitions read, and what a stop leaves.
#include <doctest/doctest.h>
#include <fmt/format.h>

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

const std::string kLamp = R"(
[source]
type = "photons"
position = ["0.5 mm", "0.5 mm", "2 mm"]
wavelength = "420 nm"
photons = 3_000
)";

}  // namespace

TEST_CASE("Each point of a sweep is built once, whoever uses it, and released when it was traced") {
  Simulation simulation(scene_of(kCrystal + kPhotons + kSurfaceSweep));
  CHECK(simulation.points() == 3);
  CHECK(simulation.counts().scenes_built == 0);
  simulation.point(2);
  CHECK(simulation.counts().scenes_built == 1);
  CHECK(simulation.header().surfaces.size() >= 3);
  CHECK(simulation.counts().scenes_built == 3);
  const auto kept = simulation.point(1);
  const RunResult result = simulation.run_all();
  CHECK(simulation.counts().scenes_built == 3);
  CHECK(result.points.size() == 3);
  CHECK(result.points[1].parameters == std::vector<std::string>{"roncali2013_unified_rough"});
  CHECK(kept.use_count() == 1);
  simulation.point(1);
  CHECK(simulation.counts().scenes_built == 4);
}

TEST_CASE("Points that differ in their source only share one scene, with the results that each has alone") {
  const SceneFile file = scene_of(kCrystal + kLamp + R"(
[[sweep]]
key = "source.position.z"
values = ["1 mm", "2 mm", "3 mm"]
)");
  Simulation simulation(file);
  simulation.build();
  CHECK(simulation.counts().scenes_built == 1);
  CHECK(simulation.point(0)->built() == simulation.point(2)->built());
  const RunResult together = simulation.run_all();
  CHECK(simulation.counts().scenes_built == 1);
  for (std::size_t i = 0; i < 3; ++i) {
    Simulation alone(file);
    const PointResult result = alone.run(i);
    CHECK(result.fates == together.points[i].fates);
    CHECK(result.segments == together.points[i].segments);
  }
  CHECK(together.points[0].fates != together.points[2].fates);
}

TEST_CASE("A source of light of other wavelengths has a scene of its own") {
  Simulation simulation(scene_of(kCrystal + kLamp + R"(
[[sweep]]
key = "source.wavelength"
values = ["420 nm", "430 nm", "420 nm"]
)"));
  simulation.build();
  CHECK(simulation.counts().scenes_built == 2);
  CHECK(simulation.point(0)->built() == simulation.point(2)->built());
}

TEST_CASE("Beyond the triangles that may be kept, points are built again with the same result") {
  const SceneFile file = scene_of(kCrystal + kPhotons + kSurfaceSweep);
  SimulationOptions options;
  options.most_triangles_kept = 30;  // one point has 24
  Simulation sparing(file, options), keeping(file);
  const RunResult a = sparing.run_all(), b = keeping.run_all();
  CHECK(sparing.counts().scenes_built == 4);  // the first is kept, and the latest
  CHECK(keeping.counts().scenes_built == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(a.points[i].fates == b.points[i].fates);
    CHECK(a.points[i].segments == b.points[i].segments);
  }
}

TEST_CASE("Each definition of the material database is read once, however many parts and points name it") {
  std::string text = "ambient = \"air\"\n";
  for (int i = 0; i < 6; ++i)
    text += fmt::format(R"(
[[part]]
name = "crystal{0}"
box = {{ low = ["{1} mm", "0 mm", "0 mm"], high = ["{2} mm", "2 mm", "4 mm"] }}
medium = "LSO"
surface = "polished"
[[part]]
name = "pmt{0}"
box = {{ low = ["{1} mm", "0 mm", "-1 mm"], high = ["{2} mm", "2 mm", "0 mm"] }}
sensor = "R6231"
)",
                        i, 3 * i, 3 * i + 2);
  text += R"(
[source]
type = "gamma_events"
region = { part = "crystal0" }
energy = "50 keV"
events = 2
[[sweep]]
key = "source.energy"
values = ["50 keV", "60 keV", "70 keV"]
)";
  Simulation simulation(scene_of(text));
  simulation.run_all();
  // air, LSO, polished, R6231.
  CHECK(simulation.counts().definitions.files == 4);
  CHECK(simulation.counts().definitions.definitions == 4);

  Simulation with_own(scene_of(text + "[media.unused]\nindex = { n = 1.5 }\nabsorption = { none = true }\n"
                                      "scattering = { none = true }\n"));
  with_own.run_all();
  CHECK(with_own.counts().definitions.files == 4);
  CHECK(with_own.counts().definitions.definitions == 5);  // and its own, which nothing uses
}

TEST_CASE("A definition that a sweep changes is read for each of its values, and what it leaves alone once") {
  Simulation simulation(scene_of(kCrystal + kPhotons + R"(
[[sweep]]
key = "surfaces.painted.reflectance"
values = [0.8, 0.9]
[[part]]
name = "block"
box = { low = ["5 mm", "0 mm", "0 mm"], high = ["6 mm", "1 mm", "1 mm"] }
medium = "LSO"
surface = "painted"
[surfaces.painted]
model = "painted"
reflectance = 0.9
specular_share = 0.0
)"));
  simulation.build();
  CHECK(simulation.counts().definitions.files == 4);
  // air, LSO and R6231 once; polished and painted, which might be based on it, twice.
  CHECK(simulation.counts().definitions.definitions == 7);
}

TEST_CASE("A stopped run keeps whole points and whole blocks, and is marked as partial") {
  std::atomic<bool> stop = false;
  SimulationHooks hooks;
  hooks.stop = &stop;
  hooks.progress = [&](const SimulationProgress& progress) {
    CHECK(progress.points == 3);
    CHECK(progress.total == 3 * 100'000);
    CHECK(progress.thing == "photons");
    stop = progress.point == 1 && progress.done >= 110'000;
  };
  SimulationOptions options;
  options.threads = 1;
  options.photons = 100'000;
  Simulation simulation(scene_of(kCrystal + kPhotons + kSurfaceSweep), options);
  MemorySink memory;
  const RunResult result = simulation.run_all(memory, hooks);
  REQUIRE(result.points.size() == 2);
  CHECK(result.points[0].complete);
  CHECK_FALSE(result.points[1].complete);
  CHECK(result.points[1].emitted >= 10'000);
  CHECK(result.points[1].emitted < 100'000);
  CHECK_FALSE(result.complete());
  CHECK(result.partial_reason == kStopped);
  CHECK(memory.result.points.size() == 2);
  CHECK(memory.result.partial_reason == kStopped);
}

TEST_CASE("A stop before the first photon is a cancellation: there is nothing to keep") {
  const std::atomic<bool> stop = true;
  SimulationHooks hooks;
  hooks.stop = &stop;
  Simulation simulation(scene_of(kCrystal + kPhotons));
  MemorySink memory;
  CHECK_THROWS_AS(simulation.run_all(memory, hooks), Cancelled);
  CHECK(memory.result.points.empty());
  CHECK(simulation.run_all(memory).complete());
}

TEST_CASE("A point that does not exist is refused") {
  Simulation simulation(scene_of(kCrystal + kPhotons + kSurfaceSweep));
  CHECK_THROWS_AS(simulation.point(3), InputError);
  CHECK_THROWS_AS(simulation.run(3), InputError);
  CHECK_THROWS_AS(simulation.spec(3), InputError);
  CHECK_THROWS_AS(simulation.parameters(3), InputError);
  CHECK(simulation.points() == 3);
}
