#include <cstring>

#include "physics/traced.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene_file;
using namespace scintray::source;
using namespace scintray::transport;
using namespace scintray::tally;
using namespace scintray::simulation;
using namespace scintray::test;

namespace {

const std::string kScene = R"(
ambient = "vacuum_n1"
[[part]]
name = "crystal"
box = ["2 mm", "2 mm", "20 mm"]
medium = "lso"
surface = "ground"
[[part]]
name = "detector"
box = ["2 mm", "2 mm", "1 mm"]
place = { touch = "crystal", side = "-z", gap = "0.1 mm", fill = "n15" }
medium = "n15"
sensor = "perfect"
[source]
type = "photons"
region = { part = "crystal" }
wavelength = "420 nm"
photons = 50_001
photons_per_event = 777
[[tally]]
type = "exit_angle"
face = "crystal:other"
[surfaces.ground]
model = "unified"
unified = { sigma_alpha = "18 deg", definition = "solid_angle", facets = "projected_area", lobe = 0.8, spike = 0.1 }
)";

/// Equal to the last bit.
void check_same(const PointResult& a, const PointResult& b) {
  CHECK(a.fates == b.fates);
  CHECK(a.absorbed_in_medium == b.absorbed_in_medium);
  CHECK(a.absorbed_at_surface == b.absorbed_at_surface);
  CHECK((a.shifted_in_medium == b.shifted_in_medium));
  CHECK(a.segments == b.segments);
  CHECK(a.scatterings == b.scatterings);
  CHECK(a.detected_path_histogram == b.detected_path_histogram);
  REQUIRE(a.tallies.size() == 2);  // angles before and behind the face
  for (std::size_t i = 0; i < a.tallies.size(); ++i) CHECK(a.tallies[i].sum == b.tallies.at(i).sum);
  for (const auto moments : {&PointResult::interactions, &PointResult::detected_path_mm,
                             &PointResult::detected_time_ns, &PointResult::detected_interactions}) {
    CHECK((a.*moments).count == (b.*moments).count);
    CHECK(std::memcmp(&(a.*moments).sum, &(b.*moments).sum, sizeof(double)) == 0);
    CHECK(std::memcmp(&(a.*moments).sum_of_squares, &(b.*moments).sum_of_squares, sizeof(double)) == 0);
  }
}

}  // namespace

TEST_CASE("Results are the same to the last bit for 1, 2 and 7 threads") {
  const PointResult one = trace(kScene, 1).result;
  CHECK(one.photons == 50'001);
  check_same(one, trace(kScene, 2).result);
  check_same(one, trace(kScene, 7).result);
}

TEST_CASE("A photon from the list can be followed again to the same end") {
  SceneSpec spec = scene_spec(kScene);
  spec.run.photon_list = true;
  const auto point = ready(std::move(spec));
  std::vector<DetectedPhoton> list;
  RunHooks hooks;
  hooks.detected = [&](const std::vector<DetectedPhoton>& photons) {
    list.insert(list.end(), photons.begin(), photons.end());
  };
  const PointResult result = point->trace(hooks);
  REQUIRE(list.size() == result.count(Fate::detected));
  for (std::size_t i = 0; i < list.size(); i += 97) {
    Step last;
    const Photon end =
        point->replay(list[i].event, list[i].photon, [&](const Photon&, const Step& step) { last = step; });
    CHECK(last.event == StepEvent::detected);
    CHECK(static_cast<float>(end.path_mm) == list[i].path_mm);
    CHECK(static_cast<float>(end.position.x()) == list[i].position_mm[0]);
    CHECK(end.interactions == list[i].interactions);
  }
}

TEST_CASE("A stopped run keeps whole blocks and says that it is partial") {
  SceneSpec spec = scene_spec(kScene);
  spec.run.threads = 1;
  std::atomic<bool> stop{false};
  RunHooks hooks;
  hooks.stop = &stop;
  hooks.progress = [&](std::uint64_t done) { stop = done >= 8'000; };
  const PointResult result = ready(std::move(spec))->trace(hooks);
  CHECK_FALSE(result.complete);
  CHECK(result.photons >= 8'000);
  CHECK(result.photons < 50'001);
  CHECK(result.lost == 0);
}

TEST_CASE("A photon cut by a limit is counted as such, with the bound on what that can change") {
  std::string scene = kScene;
  scene += "[run]\nmax_interactions = 3\n";
  const PointResult result = trace(scene).result;
  CHECK(result.count(Fate::cut_interactions) > 0);
  CHECK(result.cut_bias_bound() ==
        doctest::Approx(static_cast<double>(result.count(Fate::cut_interactions)) / 50'001.0));
}
