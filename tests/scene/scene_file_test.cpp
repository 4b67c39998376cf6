// Scene files: what is read, sweeps, and the documentation.
#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

#include "bad_input/good_scene.hpp"
#include "bad_input/marked_text.hpp"
#include "scintray/scene_file/read_scene.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::config;
using namespace scintray::mesh;
using namespace scintray::scene_file;
using namespace scintray::test;

namespace {

/// The one exit angle tally of a scene.
const TallySpec& exit_angle_of(const SceneSpec& scene) {
  const auto is = [](const TallySpec& tally) { return tally.type == kExitAngle; };
  REQUIRE(std::count_if(scene.tallies.begin(), scene.tallies.end(), is) == 1);
  return *std::find_if(scene.tallies.begin(), scene.tallies.end(), is);
}

std::string documentation() { return read_text_file(source_file("docs/scene_files.md")); }

std::string documented_example() {
  const std::string text = documentation();
  const auto begin = text.find("```toml\n") + 8;
  return text.substr(begin, text.find("```", begin) - begin);
}

/// The words in backticks of a line, up to the second column of a table.
std::vector<std::string> quoted_words(const std::string& line) {
  std::vector<std::string> words;
  const auto column = line.rfind("| `", 0) == 0 ? line.find('|', 1) : line.size();
  for (auto open = line.find('`'); open < column; open = line.find('`', line.find('`', open + 1) + 1))
    words.push_back(line.substr(open + 1, line.find('`', open + 1) - open - 1));
  return words;
}

/// "part.place.gap" of every row of every table under a heading "### `part.place`".
std::vector<std::string> documented_keys() {
  std::set<std::string> keys;
  std::vector<std::string> tables;
  std::istringstream lines(documentation());
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("#", 0) == 0) tables.clear();
    if (line.rfind("### ", 0) == 0) tables = quoted_words(line);
    if (line == "### top of the file") tables = {""};
    if (line.rfind("| `", 0) != 0) continue;
    for (const std::string& table : tables)
      for (const std::string& key : quoted_words(line)) keys.insert(table.empty() ? key : table + "." + key);
  }
  return {keys.begin(), keys.end()};
}

SceneFile documented_scene() {
  const std::filesystem::path folder = scratch_folder("documented_scene");
  std::ofstream(folder / "crystal.stl") << "solid\nendsolid\n";
  std::ofstream(folder / "detector.step") << "ISO-10303-21;\n";
  std::ofstream(folder / "reflectance.csv") << "0,0.1,0.01\n";
  return SceneFile::from_text(documented_example(), (folder / "scene.toml").string());
}

}  // namespace

TEST_CASE("the documented example is read as documented") {
  const SceneFile file = documented_scene();
  CHECK(file.points() == 5);
  const SceneSpec scene = file.spec(2);
  CHECK(scene.ambient.name == "air");
  REQUIRE(scene.parts.size() > 4);

  const PartSpec& crystal = scene.parts[0];
  const auto& mesh = std::get<MeshFileSpec>(crystal.shape);
  CHECK(mesh.path.filename() == "crystal.stl");
  CHECK(mesh.unit_mm.value_or(0.0) == 1.0);
  REQUIRE(crystal.faces.size() == 2);
  CHECK(crystal.faces[0].select.normal.value_or(Vec3::Zero()) == Vec3(0, 0, -1));
  CHECK(crystal.faces[0].select.tolerance_rad == doctest::Approx(2.0 * kDegree));
  REQUIRE(crystal.faces[1].select.box.has_value());
  CHECK(crystal.faces[1].select.box->high == Vec3(1, 1, 21));

  const PartSpec& pmt = scene.parts[1];
  const auto& box = std::get<BoxSpec>(pmt.shape);
  CHECK(box.low == Vec3(-1, -1, 0));
  CHECK(box.high == Vec3(1, 1, 0.5));
  REQUIRE(pmt.placement.touch.has_value());
  CHECK(pmt.placement.touch->side.axis == 2);
  CHECK(pmt.placement.touch->side.sign == -1);
  CHECK(pmt.placement.touch->gap_mm == doctest::Approx(0.1));
  CHECK(pmt.placement.touch->fill.name == "optical_grease");
  CHECK(pmt.sensor.name == "R6231");
  CHECK(pmt.medium.empty());

  const PartSpec& rod = scene.parts[3];
  CHECK(std::get<CylinderSpec>(rod.shape).segments == 48);
  REQUIRE(rod.placement.rotate.size() == 2);
  CHECK(rod.placement.rotate[1].angle_rad == doctest::Approx(45.0 * kDegree));
  CHECK(rod.placement.translate == Vec3(-8, 0, 3));
  CHECK(rod.medium.name == kOpaqueMedium);

  const auto step = std::find_if(scene.parts.begin(), scene.parts.end(),
                                 [](const PartSpec& part) { return part.name.name == "step"; });
  REQUIRE(step != scene.parts.end());
  const auto& cad = std::get<MeshFileSpec>(step->shape);
  CHECK_FALSE(cad.unit_mm.has_value());
  CHECK(cad.body == "light guide");
  CHECK(cad.tessellation.angle_rad == doctest::Approx(5.0 * kDegree));
  CHECK(step->faces.at(0).select.tags == FaceTags{{"color", "#ff8000"}});

  CHECK(scene.parts[2].priority == 1);
  REQUIRE(scene.contacts.size() >= 2);  // those of builders follow
  CHECK(scene.contacts[0].between[1].name == "pmt_fill");
  CHECK(scene.contacts[0].faces[1].empty());
  CHECK(scene.contacts[0].tolerance_mm.value_or(0.0) == doctest::Approx(0.02));
  CHECK(scene.contacts[1].between[0].name == "crystal");
  CHECK(scene.contacts[1].faces[0] == "exit");
  CHECK(scene.contacts[1].faces[1] == "other");
  CHECK_FALSE(scene.contacts[1].tolerance_mm.has_value());
  const auto& region = std::get<RegionSpec>(scene.source.origin);
  REQUIRE(region.slab_z_mm.has_value());
  CHECK((*region.slab_z_mm)[0] == doctest::Approx(9.25));
  CHECK((*region.slab_z_mm)[1] == doctest::Approx(10.75));
  CHECK(scene.source.direction.kind == DirectionKind::cone);
  CHECK(scene.source.direction.half_angle_rad == doctest::Approx(30.0 * kDegree));
  CHECK(scene.source.wavelength_nm.value_or(0.0) == 420.0);
  CHECK(scene.source.photons == 100000);
  CHECK(scene.run.max_time_ns.value_or(0.0) == 500.0);
  CHECK(scene.run.threads.value_or(0) == 4);
  REQUIRE(scene.run.until);
  CHECK(scene.run.until->fate == Fate::detected);
  CHECK(scene.run.until->relative_error.value_or(0.0) == doctest::Approx(0.005));
  CHECK(scene.run.until->absolute_error.value_or(0.0) == doctest::Approx(0.001));
  CHECK(scene.run.until->wall_time_s.value_or(0.0) == doctest::Approx(3600.0));
  CHECK(scene.run.until->photons.value_or(0) == 50'000);
  CHECK(scene.run.contact_tolerance_mm == doctest::Approx(1e-4));
  const TallySpec& angles = exit_angle_of(scene);
  CHECK(angles.detected_only());
  REQUIRE(angles.faces.size() == 1);
  CHECK(angles.faces[0].name == "crystal:exit");
  CHECK(scene.media.count("glass") == 1);
  CHECK(scene.surfaces.count("lso_ground") == 1);
  CHECK(scene.sensors.count("R6231") == 1);
  CHECK(scene.reflectors.count("paper") == 1);
}

TEST_CASE("the documentation names every key, and no other") {
  const std::vector<std::string> documented = documented_keys();
  const std::vector<std::string> known = scene_keys(parse_toml(documented_example(), "scene.toml"));
  CHECK(known.size() > 60);
  for (const std::string& key : known) {
    INFO("read but not documented: " << key);
    const bool own_name = key.rfind("media.", 0) == 0 || key.rfind("surfaces.", 0) == 0 ||
                          key.rfind("sensors.", 0) == 0 || key.rfind("reflectors.", 0) == 0;
    CHECK((own_name || std::binary_search(documented.begin(), documented.end(), key)));
  }
  for (const std::string& key : documented) {
    INFO("documented but not read: " << key);
    CHECK(std::binary_search(known.begin(), known.end(), key));
  }
}

TEST_CASE("what a scene leaves out has the documented default") {
  const SceneSpec scene =
      SceneFile::from_text(replaced(kGoodScene, "[run]\nseed = 7\n", ""), "scene.toml").spec(0);
  CHECK(scene.contacts_default == ContactKind::bonded);
  CHECK_FALSE(scene.contacts_default_given);
  CHECK(scene.source.direction.kind == DirectionKind::isotropic);
  CHECK(scene.source.time_ns.value_or(-1.0) == 0.0);
  CHECK_FALSE(scene.source.unpolarised);
  CHECK(scene.source.photons_per_event == 1000);
  CHECK(scene.run.seed == 1);
  CHECK(scene.run.max_interactions == 100000);
  CHECK_FALSE(scene.run.max_time_ns.has_value());
  CHECK(scene.run.contact_tolerance_mm == 1e-4);
  CHECK(scene.run.accelerator == AcceleratorKind::automatic);
  CHECK(scene.run.curved == CurvedFaces::exact);
  CHECK_FALSE(scene.run.photon_list);
  CHECK_FALSE(scene.run.photon_history);
  CHECK(scene.run.paths == 0);
  const TallySpec& angles = exit_angle_of(scene);
  REQUIRE(angles.axes.size() == 1);
  CHECK(angles.axes[0].bins == 18);
  CHECK(angles.name == "crystal:exit");
}

TEST_CASE("a sweep sets every key that it names to its value") {
  const SceneFile file = SceneFile::from_text(std::string(kGoodScene) + R"(
[[sweep]]
key = "run.seed"
also = ["source.photons", "run.max_interactions"]
values = [21, 22]
)",
                                              "scene.toml");
  REQUIRE(file.points() == 4);
  const SceneSpec second = file.spec(3);
  CHECK(second.run.seed == 22);
  CHECK(second.source.photons == 22);
  CHECK(second.run.max_interactions == 22);
  const std::string twice = complaint_of([] {
    SceneFile::from_text(std::string(kGoodScene) + R"(
[[sweep]]
key = "run.seed"
also = ["source.photons"]
values = [21, 22]
[[sweep]]
key = "source.photons"
values = [1, 2]
)",
                         "scene.toml");
  });
  CHECK(contains(twice, "\"source.photons\" is swept twice"));
}

TEST_CASE("several sweeps multiply, the first slowest") {
  const SceneFile file = SceneFile::from_text(std::string(kGoodScene) + R"(
[[sweep]]
key = "part.crystal.surface"
label = "finish"
values = ["ground", "polished", "etched"]
)",
                                              "scene.toml");
  CHECK(file.points() == 6);
  CHECK(file.sweep_keys() == std::vector<std::string>{"source.region.slab_z.center", "finish"});
  CHECK(file.parameters(0) == std::vector<std::string>{"2 mm", "ground"});
  CHECK(file.parameters(2) == std::vector<std::string>{"2 mm", "etched"});
  CHECK(file.parameters(3) == std::vector<std::string>{"6 mm", "ground"});
  const SceneSpec scene = file.spec(4);
  CHECK(scene.parts[0].surface.name == "polished");
  const std::array<double, 2> slab =
      std::get<RegionSpec>(scene.source.origin).slab_z_mm.value_or(std::array{0.0, 0.0});
  CHECK(slab[0] == doctest::Approx(5.0));
  CHECK(slab[1] == doctest::Approx(7.0));
}

TEST_CASE("a swept value keeps its place in the sweep") {
  const SceneFile file = SceneFile::from_text(std::string(kGoodScene) + R"(
[[sweep]]
key = "part.crystal.face.exit.surface"
values = ["polished", "etched"]
)",
                                              "scene.toml");
  const NameRef surface = file.spec(1).parts[0].faces[0].surface;
  CHECK(surface.name == "etched");
  CHECK(surface.where.text() == "scene.toml:46:23");
}

TEST_CASE("sweeps reach nested keys, coordinates, and keys that are not in the file") {
  const std::string base =
      replaced(replaced(kGoodScene, "region = { part = \"crystal\", slab_z = [\"1 mm\", \"3 mm\"] }",
                        "position = [\"0 mm\", \"0 mm\", \"5 mm\"]"),
               "[[sweep]]\nkey = \"source.region.slab_z.center\"\nvalues = [\"2 mm\", \"6 mm\"]", "");
  const auto swept = [&](const std::string& key, const std::string& value) {
    return SceneFile::from_text(base + "\n[[sweep]]\nkey = \"" + key + "\"\nvalues = [" + value + "]\n",
                                "scene.toml")
        .spec(0);
  };
  CHECK(std::get<Vec3>(swept("source.position.z", "\"7 mm\"").source.origin) == Vec3(0, 0, 7));
  CHECK(swept("part.pmt.place.gap", "\"0.3 mm\"").parts[1].placement.touch->gap_mm == doctest::Approx(0.3));
  CHECK(swept("run.max_interactions", "50").run.max_interactions == 50);
  const SceneSpec turned = swept("part.crystal.face.exit.select.normal", "[0, 0, 2]");
  CHECK(turned.parts[0].faces[0].select.normal.value_or(Vec3::Zero()) == Vec3(0, 0, 1));
  CHECK(swept("media.grease.index.value", "1.4").media.at("grease")->find("index")->find("value")->number ==
        1.4);
}

TEST_CASE("faces without a name are called after what selects them") {
  const SceneSpec scene = SceneFile::from_text(replaced(replaced(kGoodScene, "name = \"exit\"\n", ""),
                                                        "face = \"crystal:exit\"", "face = \"crystal:-z\""),
                                               "scene.toml")
                              .spec(0);
  CHECK(scene.parts[0].faces[0].name == "-z");
}

TEST_CASE("definitions that parts, faces, contacts and definitions name are used") {
  const SceneFile scene = SceneFile::from_text(R"(
ambient = "gas"
[[part]]
name = "crystal"
box = ["2 mm", "2 mm", "2 mm"]
medium = "LSO"
surface = "side"
[[part.face]]
name = "top"
select = { normal = [0, 0, 1] }
surface = "coated"
[source]
type = "photons"
region = { part = "crystal" }
wavelength = "420 nm"
photons = 1
[media.gas]
index = { n = 1.0 }
absorption = { none = true }
scattering = { none = true }
[media.crystal]
base = "gas"
[surfaces.side]
base = "polished"
[surfaces.coated]
base = "inner"
[surfaces.inner]
base = "polished"
)",
                                               "scene.toml");
  std::vector<std::string> unused;
  for (const DefinitionRef& definition : scene.unused_definitions())
    unused.push_back(definition_key(definition));
  CHECK(unused == std::vector<std::string>{"media.crystal"});  // the name of a part is not that of its medium
}

TEST_CASE("A cone has two radii, one of which may be 0, and round faces may stay facets") {
  const std::string with_cone =
      replaced(kGoodScene, "box = [\"2 mm\", \"2 mm\", \"20 mm\"]",
               "cone = { bottom_radius = \"2 mm\", top_radius = \"0 mm\", height = \"3 mm\" }");
  const SceneSpec scene =
      SceneFile::from_text(replaced(with_cone, "[run]\n", "[run]\ncurved = \"facets\"\n"), "scene.toml")
          .spec(0);
  const auto& cone = std::get<ConeSpec>(scene.parts[0].shape);
  CHECK(cone.bottom_radius_mm == 2.0);
  CHECK(cone.top_radius_mm == 0.0);
  CHECK(cone.height_mm == 3.0);
  CHECK(cone.segments == 64);
  CHECK(scene.run.curved == CurvedFaces::facets);
}
