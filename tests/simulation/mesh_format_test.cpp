// A scene with a part in a mesh format from outside.
#include "scintray/simulation/simulation.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "mesh/toy_format.hpp"
#include "scenes.hpp"

using namespace scintray;
using namespace scintray::simulation;
using namespace scintray::test;

namespace {

/// A crystal of 1 x 2 x 3 cm from a file, on a sensor.
scene_file::SceneFile crystal_of(const std::filesystem::path& mesh, const std::string& keys = "") {
  return scene_of("ambient = \"air\"\n[[part]]\nname = \"crystal\"\nmesh = \"" + mesh.generic_string() +
                  "\"\n" + keys + R"(
medium = "LSO"
surface = "polished"
[[part]]
name = "pmt"
box = { low = ["0 mm", "0 mm", "-1 mm"], high = ["10 mm", "20 mm", "0 mm"] }
sensor = "R6231"
)" + kPhotons);
}

SimulationOptions with_formats(const mesh::MeshFormats& formats) {
  SimulationOptions options;
  options.mesh_formats = &formats;
  return options;
}

}  // namespace

TEST_CASE(
    "A scene names a mesh of a format from outside, and traces as with the same mesh of a built-in format") {
  const mesh::MeshFormats formats = with_toy();
  Simulation toy(crystal_of(mesh_file("crystal.toy", kToyBox)), with_formats(formats));
  const auto obj = mesh_file("crystal.obj", corner_lines("v ") + quad_lines("f ", 1));
  Simulation built_in(crystal_of(obj, "unit = \"cm\""));
  CHECK(toy.point(0)->built()->parts.at(0).diagnosis.volume_mm3 == doctest::Approx(6000.0));

  const tally::RunResult a = toy.run_all(), b = built_in.run_all();
  REQUIRE(a.points.size() == 1);
  CHECK(a.points[0].emitted == 3'000);
  CHECK(a.points[0].fraction(core::Fate::detected).value > 0.0);
  CHECK(a.points[0].fates == b.points[0].fates);
  CHECK(a.points[0].segments == b.points[0].segments);
}

TEST_CASE("Unit, scale and body of a part hold for a mesh format from outside") {
  const mesh::MeshFormats formats = with_toy();
  const auto two = mesh_file("pair.toy", kToyBox + "solid lid\nf 0 2 1\nf 0 1 4\nf 0 4 2\nf 1 2 4\n");
  Simulation lid(crystal_of(two, "unit = \"cm\"\nscale = 0.5\nbody = \"lid\""), with_formats(formats));
  CHECK(lid.point(0)->built()->parts.at(0).diagnosis.volume_mm3 == doctest::Approx(125.0));
  check_contains(
      complaint_of([&] { Simulation(crystal_of(two, "unit = \"mm\""), with_formats(formats)).build(); }),
      {"pair.toy", "the file states the unit cm"});
}

TEST_CASE("Elements of an array are of a mesh format from outside, as the part that they repeat") {
  const std::string element = mesh_file("element.toy", kToyBox).generic_string();
  const std::string text = R"(ambient = "air"
[[array]]
name = "block"
count = [2, 2]
gap = "0.1 mm"
element = { mesh = ")" + element +
                           R"(", medium = "LSO", surface = "polished" }
[[part]]
name = "pmt"
box = { low = ["-11 mm", "-21 mm", "-1 mm"], high = ["11 mm", "21 mm", "0 mm"] }
sensor = "R6231"
[source]
type = "photons"
region = { part = "block[0,0]" }
wavelength = "420 nm"
photons = 100
)";
  const auto load = [&](const scene_file::Extensions& extensions) {
    return scene_file::SceneFile::from_text(text, source_file("test.toml").string(), extensions);
  };
  Simulation simulation(load({.mesh_formats = with_toy()}));
  const auto built = simulation.point(0)->built();
  CHECK(built->parts.size() == 5);
  CHECK(built->parts.at(3).diagnosis.volume_mm3 == doctest::Approx(6000.0));
  const auto last = std::find_if(built->scene.parts.begin(), built->scene.parts.end(),
                                 [](const scene::PartInfo& part) { return part.name == "block[1,1]"; });
  REQUIRE(last != built->scene.parts.end());
  CHECK(last->bounds.max().x() == doctest::Approx(10.05));
  check_contains(complaint_of([&] { load({}); }), {"test.toml:6", "\".toy\" is not a mesh format"});
}

TEST_CASE("Without the list, a scene with a mesh of a format from outside is refused, and the file named") {
  const auto path = mesh_file("crystal.toy", kToyBox);
  check_contains(complaint_of([&] { Simulation(crystal_of(path)).build(); }),
                 {"crystal.toy", "\".toy\" is not a mesh format"});
}
