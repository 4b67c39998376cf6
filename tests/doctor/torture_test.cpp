#include "doctor/doctor_scenes.hpp"
#include "support/long_run.hpp"
#include "support/photon_source.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene_file;
using namespace scintray::scene;
using namespace scintray::tally;
using namespace scintray::simulation;
using namespace scintray::test;

// scenes/torture.toml: slivers, grazing rays, gaps of 1e-4 mm, ten metres from the origin, sensors along
// partial faces. SCINTRAY_TORTURE_STEPS=1e9 makes it as long as one likes.

TEST_CASE("No photon is lost in the torture scene") {
  const SceneSpec spec = SceneFile::load(source_file("scenes/torture.toml")).spec(0);
  lose_no_photon("torture", spec, wanted_steps(2e6));
}

TEST_CASE("Beams that graze the crystal's long faces lose nothing") {
  SceneSpec spec = SceneFile::load(source_file("scenes/torture.toml")).spec(0);
  const auto built = std::make_shared<const BuiltScene>(SceneBuilder().build(spec));
  // The crystal's own x and z axes, as the scene turns them.
  const Eigen::AngleAxisd turn(33.0 * kDegree, Vec3(1, 2, 3).normalized());
  for (const double tilt : {1e-2, 1e-4, 1e-6, 1e-8, 1e-12, 0.0}) {
    CAPTURE(tilt);
    spec.source.direction.kind = DirectionKind::beam;
    spec.source.direction.axis = (turn * Vec3(tilt, 0.3 * tilt, 1.0)).normalized();
    const SimulationPoint point(spec, built);
    const PointResult result = point.trace();
    CHECK(result.lost == 0);
    CHECK(result.photons == point.work());
  }
}

TEST_CASE("Every flight of the torture scene lies in the region that its photon is in") {
  const SceneSpec spec = SceneFile::load(source_file("scenes/torture.toml")).spec(0);
  const BuiltScene built = SceneBuilder().build(spec);
  check_propagation(built.scene, spec.source, 300);
}
