// A run of a scene that names a surface model from outside.
#include <doctest/doctest.h>

#include "scenes.hpp"
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

const std::string kScene = R"(
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

}  // namespace

TEST_CASE("A run follows photons through a surface model from outside") {
  SimulationOptions options;
  options.models.surfaces.add({.word = "ghost", .table = "", .read = [](const config::TomlTable&) {
                                 return FixedMicrosurface(Ghost());
                               }});
  Simulation simulation(scene_of(kScene), options);
  const tally::RunResult result = simulation.run_all();
  CHECK(result.points.front().fraction(Fate::escaped).value == 1.0);
  CHECK_THROWS_AS(Simulation(scene_of(kScene)).run_all(), InputError);
}
