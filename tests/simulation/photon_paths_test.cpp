// Paths of single photons: those that the run traces.
#include <doctest/doctest.h>

#include "scenes.hpp"
#include "scintray/simulation/photon_paths.hpp"
#include "scintray/simulation/simulation.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::simulation;
using namespace scintray::test;

TEST_CASE(
    "Paths of all photons of a run have its fates, begin where they are emitted and go forward in time") {
  Simulation simulation(scene_of(kCrystal + R"(
[source]
type = "photons"
position = ["0.5 mm", "0.5 mm", "2 mm"]
wavelength = "420 nm"
photons = 400
[run]
efficiency_at_birth = false
)"));
  const auto point = simulation.point(0);
  const tally::PointResult result = point->trace();
  const std::vector<PhotonPath> paths = photon_paths(*point, 1'000'000);
  REQUIRE(paths.size() == 400);
  std::array<std::uint64_t, kFateCount> fates{};
  for (const PhotonPath& path : paths) {
    ++fates[fate_index(path.fate)];
    REQUIRE(path.vertices.size() >= 2);
    CHECK((path.vertices.front().position - Vec3(0.5, 0.5, 2.0)).norm() < 1e-12);
    for (std::size_t i = 1; i < path.vertices.size(); ++i)
      CHECK(path.vertices[i].time_ns >= path.vertices[i - 1].time_ns);
  }
  for (int i = 0; i < kFateCount; ++i) CHECK(fates[static_cast<std::size_t>(i)] == result.count(fate_at(i)));
  CHECK(photon_paths(*point, 7).size() == 7);
}
