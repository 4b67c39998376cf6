#include <string>

#include "physics/traced.hpp"
#include "scintray/core/lane_width.hpp"
#include "scintray/transport/batch.hpp"
#include "scintray/transport/detail/lane_scene.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::simulation;
using namespace scintray::transport;
using namespace scintray::test;

namespace {

/// Crystals of absorbing LSO in a filler that absorbs and scatters as well, and a sensor behind grease.
std::string filled_array(const std::string& surface, const std::string& more = "") {
  return R"(
ambient = "vacuum"
contacts_default = "bonded"
[media.glue]
index = { n = 1.5 }
absorption = { length = "3 mm" }
scattering = { length = "2 mm", kind = "isotropic" }
[[array]]
name = "crystal"
count = [3, 3]
pitch = "2.1 mm"
filler = "glue"
[array.element]
box = ["2 mm", "2 mm", "8 mm"]
medium = "LSO_roncali2013"
surface = ")" +
         surface + R"("
)" + more +
         R"(
[[part]]
name = "detector"
box = ["6.2 mm", "6.2 mm", "1 mm"]
place = { touch = "crystal", side = "-z", gap = "0.1 mm", fill = "optical_grease_roncali2013" }
medium = "optical_grease_roncali2013"
surface = "polished"
sensor = "ideal"
[source]
type = "photons"
region = { part = "crystal[1,1]" }
wavelength = "420 nm"
photons = 3_000
)";
}
/// Sheets that end 1 mm above the sensor, and around the crystals, with air in between.
const char* const kSepta = R"(
[array.septa]
reflector = "ESR"
thickness = "0.065 mm"
height = ["1 mm", "8 mm"]
[array.wrap]
reflector = "ESR"
thickness = "0.065 mm"
sides = ["-x", "+x", "-y", "+y", "+z"]
)";

/// A crystal in film, the air between them a region of its own.
std::string in_film(const std::string& surface, const std::string& wavelength) {
  return R"(
ambient = "air"
[[array]]
name = "crystal"
count = [1, 1]
pitch = "2 mm"
[array.element]
box = ["2 mm", "2 mm", "10 mm"]
medium = "LSO"
surface = ")" +
         surface + R"("
[array.wrap]
reflector = "PTFE"
thickness = "0.3 mm"
gap = "0.05 mm"
sides = ["-x", "+x", "-y", "+y", "+z"]
[[part]]
name = "detector"
box = ["2 mm", "2 mm", "1 mm"]
place = { touch = "crystal[0,0]", side = "-z", gap = "0.02 mm" }
medium = "optical_grease"
sensor = "ideal"
[source]
type = "photons"
region = { part = "crystal[0,0]" }
wavelength = ")" +
         wavelength + R"("
photons = 3_000
)";
}

/// Bare crystals on sensors of their own, and an air pocket that reflects light in the glass between totally.
std::string in_glass(const std::string& wavelength) {
  return R"(
ambient = "n15"
[[array]]
name = "crystal"
count = [3, 2]
gap = "0.1 mm"
[array.element]
box = ["2 mm", "2 mm", "8 mm"]
medium = "LSO"
surface = "polished"
[[part]]
name = "pocket"
box = ["6 mm", "1 mm", "8 mm"]
translate = ["0 mm", "2.6 mm", "0 mm"]
medium = "vacuum_n1"
surface = "polished"
[[array]]
name = "sipm"
count = [3, 2]
gap = "0.1 mm"
place = { touch = "crystal", side = "-z", gap = "0.1 mm", fill = "optical_grease" }
[array.element]
box = ["2 mm", "2 mm", "0.3 mm"]
sensor = "ideal"
[source]
type = "photons"
region = { part = "crystal[*]" }
wavelength = ")" +
         wavelength + R"("
photons = 3_000
)";
}

/// Kernels of the regions of some parts, by the part's name up to its first number.
LaneKind kind_of_part(const scene::Scene& scene, const LanePlan& lanes, const std::string& name) {
  for (std::uint32_t i = 0; i < scene.regions.size(); ++i)
    if (scene.region_names[RegionId(i)] == name) return lanes.kind(RegionId(i));
  FAIL("no region " << name);
  return LaneKind::none;
}

}  // namespace

TEST_CASE("Photons that stay in lanes from region to region have the same bits in every width") {
  std::string scene, crystal = "crystal[1,1]";
  SUBCASE("in glue") { scene = filled_array("polished"); }
  SUBCASE("in glue, facets") { scene = filled_array("roncali2013_unified_rough"); }
  SUBCASE("between septa, in a wrap") { scene = filled_array("polished", kSepta); }
  SUBCASE("between septa, facets") { scene = filled_array("roncali2013_unified_rough", kSepta); }
  SUBCASE("between septa, cut by interactions") {
    scene = filled_array("polished", kSepta) + "[run]\nmax_interactions = 12\n";
  }
  SUBCASE("between septa, cut by time") {
    scene = filled_array("polished", kSepta) + "[run]\nmax_time = \"0.2 ns\"\n";
  }
  SUBCASE("film") { scene = in_film("polished", "420 nm"), crystal = "crystal[0,0]"; }
  SUBCASE("film, table") { scene = in_film("lso_ground_30um_420nm", "420 nm"), crystal = "crystal[0,0]"; }
  SUBCASE("film, wavelengths of the emission") {
    scene = in_film("polished", "emission"), crystal = "crystal[0,0]";
  }
  SUBCASE("film, facets, wavelengths of the emission") {
    scene = in_film("roncali2013_unified_rough", "emission"), crystal = "crystal[0,0]";
  }
  SUBCASE("glass") { scene = in_glass("420 nm"); }
  SUBCASE("glass, wavelengths of the emission") { scene = in_glass("emission"); }
  const auto point = ready(scene_spec(scene));
  const TracedPhotons alone = trace_with(scene, 1);
  REQUIRE(alone.result.photons >= 3'000);
  REQUIRE(alone.result.segments > 10'000);
  for (const int width : lane_widths()) {
    CAPTURE(width);
    const LanePlan lanes(point->scene(), width);
    if (width >= 4) CHECK(kind_of_part(point->scene(), lanes, crystal) == LaneKind::surfaces);
    check_same(alone, trace_with(scene, width));
  }
}

TEST_CASE("Each face in lanes knows itself in the region behind it") {
  if (lane_widths().back() < 4) return;
  for (const std::string& text : {filled_array("polished", kSepta), in_glass("420 nm")}) {
    const auto point = ready(scene_spec(text));
    const scene::Scene& scene = point->scene();
    const LanePlan lanes(scene, lane_widths().back());
    int into_gaps = 0, out_of_gaps = 0, gaps = 0;
    for (std::uint32_t i = 0; i < scene.regions.size(); ++i) {
      if (lanes.kind(RegionId(i)) != LaneKind::surfaces) continue;
      const LaneRegion& region = lanes.scene().region(RegionId(i));
      REQUIRE(region.number == i);
      for (std::size_t number = 0; number < lanes.scene().face_count(RegionId(i)); ++number) {
        const LaneFace& face = region.faces[number];
        gaps += region.has_gaps != 0 && face.gap->high_x > face.gap->low_x ? 1 : 0;
        if (face.behind == nullptr) continue;
        CHECK(lanes.kind(RegionId(face.behind->number)) == LaneKind::surfaces);
        for (int axis = 0; axis < 3; ++axis)
          CHECK(face.behind_centre[axis] == scene.regions[RegionId(face.behind->number)].centre[axis]);
        if (face.behind->has_gaps == 0) {
          ++out_of_gaps;
          continue;
        }
        ++into_gaps;
        const LaneFace& there = face.behind->faces[static_cast<std::size_t>(face.behind_face)];
        for (int axis = 0; axis < 3; ++axis)
          CHECK(there.normal[axis] == doctest::Approx(-face.normal[axis]).epsilon(1e-12));
        CHECK(there.behind == &region);
      }
    }
    CHECK(gaps > 15);
    CHECK(into_gaps > 15);
    CHECK(out_of_gaps == into_gaps);
  }
}
