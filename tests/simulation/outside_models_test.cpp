// Runs of scenes that name a surface model, and a sensor model, from outside.
#include <doctest/doctest.h>

#include "scenes.hpp"
#include "scintray/detector/avalanche_model.hpp"
#include "scintray/simulation/memory_sink.hpp"
#include "scintray/simulation/simulation.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::materials;
using namespace scintray::simulation;
using namespace scintray::test;

namespace {

/// Passes all light as it is, whatever the indices.
class Ghost : public MicrosurfaceModel {
 public:
  SurfaceOutcome scatter(Ray&, Side side, const IndexPair&, SurfaceInteraction&) const override {
    return outcome_on(other(side));
  }
};

/// A sensor that answers an event with one avalanche of `charge`, however many its photons.
class OneShotProcess : public detector::AvalancheProcess {
 public:
  explicit OneShotProcess(double charge) : charge_(charge) {}
  void fire(std::vector<detector::Carrier>& carriers, double, Rng&,
            const detector::AvalancheSink& deliver) const override {
    if (!carriers.empty()) deliver(carriers.front().time_ns, charge_, carriers.front().cause);
  }

 private:
  double charge_;
};

class OneShotModel : public detector::AvalancheModel {
 public:
  explicit OneShotModel(double charge) : charge_(charge) {}
  std::unique_ptr<const detector::AvalancheProcess> on(const detector::SensorFace&) const override {
    return std::make_unique<const OneShotProcess>(charge_);
  }

 private:
  double charge_;
};

const std::string kGhostScene = R"(
ambient = "air"
[[part]]
name = "crystal"
box = ["2 mm", "2 mm", "4 mm"]
medium = "clear"
surface = "ghost"
[source]
type = "photons"
region = { part = "crystal" }
wavelength = "420 nm"
photons = 2_000
[media.clear]
index = { n = 1.82 }
absorption = { none = true }
scattering = { none = true }
[surfaces.ghost]
model = "ghost"
)";

/// kCrystal and kEvents on a sensor of that model, with electronics that change no charge.
std::string one_shot_scene() {
  std::string crystal = kCrystal;
  crystal.replace(crystal.find("R6231"), 5, "mine");
  return crystal + kEvents + R"([readout]
period = "1 ns"
before = "10 ns"
window = "500 ns"
shaping = { order = 1, time_constant = "5 ns" }
threshold = 3
[sensors.mine]
model = "one_shot"
one_shot = { charge = 7 }
window = { index = 1.5 }
efficiency = { value = 0.5, definition = "internal" }
)";
}

}  // namespace

TEST_CASE("A run follows photons through a surface model from outside") {
  SimulationOptions options;
  options.models.surfaces.add({.word = "ghost", .table = "", .read = [](const config::TomlTable&) {
                                 return FixedMicrosurface(Ghost());
                               }});
  Simulation simulation(scene_of(kGhostScene), options);
  const tally::RunResult result = simulation.run_all();
  CHECK(result.points.front().fraction(Fate::escaped).value == 1.0);
  CHECK_THROWS_AS(Simulation(scene_of(kGhostScene)).run_all(), InputError);
}

TEST_CASE("A run reads its events out by a sensor model from outside") {
  SimulationOptions options;
  options.models.sensors.add(
      {.word = "one_shot",
       .table = "one_shot",
       .read = [](const config::TomlTable& sensor, SourceRule, std::vector<std::string>&) {
         return OneShotModel(sensor.table("one_shot").number("charge"));
       }});
  Simulation simulation(scene_of(one_shot_scene()), options);
  MemorySink memory;
  simulation.run_all(memory);
  REQUIRE(memory.event_list.size() == 12);
  for (const tally::EventRecord& event : memory.event_list) {
    CAPTURE(event.event);
    CHECK(event.detected > 7);
    CHECK(event.channels.at(0).charge == 7.0f);
  }
  CHECK_THROWS_AS(Simulation(scene_of(one_shot_scene())).run_all(), InputError);
}
