// Paths of single photons: those that the run traces.
#include <doctest/doctest.h>

#include "scenes.hpp"
#include "scintray/results/results.hpp"
#include "scintray/simulation/photon_paths.hpp"
#include "scintray/simulation/results_file.hpp"
#include "scintray/simulation/simulation.hpp"
#include "support/words.hpp"

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
  const std::vector<tally::PhotonPath> paths = photon_paths(*point, 1'000'000);
  REQUIRE(paths.size() == 400);
  std::array<std::uint64_t, kFateCount> fates{};
  for (const tally::PhotonPath& path : paths) {
    ++fates[fate_index(path.fate)];
    REQUIRE(path.steps.size() >= 2);
    CHECK((path.steps.front().position - Vec3(0.5, 0.5, 2.0)).norm() < 1e-12);
    for (std::size_t i = 1; i < path.steps.size(); ++i)
      CHECK(path.steps[i].time_ns >= path.steps[i - 1].time_ns);
  }
  for (int i = 0; i < kFateCount; ++i) CHECK(fates[static_cast<std::size_t>(i)] == result.count(fate_at(i)));
  CHECK(photon_paths(*point, 7).size() == 7);
}

TEST_CASE(
    "The results file holds the paths that [run] requests, those of the run's detected photons, and no "
    "result changes") {
  const std::string lists = "[run]\nphoton_list = true\nefficiency_at_birth = false\n";
  const auto folder = scratch_folder("photon_paths_file");
  for (const std::string& source : {kPhotons, kEvents}) {
    ResultsFile with(folder / "with.h5"), without(folder / "without.h5");
    const tally::RunResult traced =
        Simulation(scene_of(kCrystal + source + lists + "paths = 90\n")).run_all(with);
    const tally::RunResult other = Simulation(scene_of(kCrystal + source + lists)).run_all(without);
    CHECK(traced.points[0].fates == other.points[0].fates);
    CHECK(traced.points[0].segments == other.points[0].segments);
    CHECK(results::read_paths(folder / "without.h5", 0).empty());
    CHECK(results::read_paths(folder / "with.h5", 1).empty());
    const std::vector<tally::PhotonPath> paths = results::read_paths(folder / "with.h5", 0);
    REQUIRE(paths.size() == 90);
    const std::vector<tally::DetectedPhoton> listed = results::read_photons(folder / "with.h5", 0, 1'000'000);
    std::size_t detected = 0;
    for (const tally::PhotonPath& path : paths) {
      const auto same = [&](const tally::DetectedPhoton& photon) {
        return photon.event == path.event && photon.photon == path.photon;
      };
      const auto row = std::find_if(listed.begin(), listed.end(), same);
      CHECK((path.fate == Fate::detected) == (row != listed.end()));
      check_contains(path.steps.front().text, "emitted in crystal");
      if (row == listed.end()) continue;
      ++detected;
      CHECK(static_cast<float>(path.steps.back().time_ns) == row->time_ns);
      CHECK(static_cast<float>(path.steps.back().position.x()) == row->position_mm[0]);
      CHECK(static_cast<float>(path.steps.back().wavelength_nm) == row->wavelength_nm);
      CHECK(path.steps.back().text == "detected by pmt");
    }
    CHECK(detected > 3);
  }
}
