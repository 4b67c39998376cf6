#include <doctest/doctest.h>

#include <fstream>

#include "scintray/core/step_event.hpp"
#include "scintray/exchange/scene_draft.hpp"
#include "scintray/scene/build_scene.hpp"
#include "scintray/scene_file/read_scene.hpp"
#include "scintray/simulation/simulation.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::exchange;
using namespace scintray::scene_file;
using namespace scintray::test;

namespace {

// A crystal with two surfaces, and a photodiode on its +z end. PLACEMENT and MORE are replaced by tests.
constexpr const char* kMacro = R"(# one block
/gate/geometry/setMaterialDatabase Materials.db
/gate/world/geometry/setXLength 1 m
/gate/world/geometry/setYLength 1 m
/gate/world/geometry/setZLength 1 m
/gate/world/setMaterial Air
/gate/world/daughters/name block
/gate/world/daughters/insert box
/gate/block/geometry/setXLength 10. mm
/gate/block/geometry/setYLength 10. mm
/gate/block/geometry/setZLength 3 cm
/gate/block/setMaterial Air
/gate/block/daughters/name crystal
/gate/block/daughters/insert box
/gate/crystal/geometry/setXLength 2 mm
/gate/crystal/geometry/setYLength 2 mm
/gate/crystal/geometry/setZLength 20 mm
/gate/crystal/setMaterial LSO
/gate/block/daughters/name diode
/gate/block/daughters/insert box
/gate/diode/geometry/setXLength 9 mm
/gate/diode/geometry/setYLength 9 mm
/gate/diode/geometry/setZLength 1 mm
/gate/diode/placement/setTranslation 0 0 10.5 mm
/gate/diode/setMaterial Epoxy
/gate/crystal/surfaces/name to_air
/gate/crystal/surfaces/insert block
/gate/crystal/surfaces/to_air/setSurface wrapped
/gate/crystal/surfaces/name to_diode
/gate/crystal/surfaces/insert diode
/gate/crystal/surfaces/to_diode/setSurface diode
)";

constexpr const char* kDatabase = R"([Elements]
Hydrogen: S= H  ; Z=  1. ; A=   1.01 g/mole
Oxygen:   S= O  ; Z=  8. ; A=  16.00 g/mole
Silicon:  S= Si ; Z= 14. ; A=  28.09 g/mole
Lutetium: S= Lu ; Z= 71. ; A= 174.97 g/mole
[Materials]
LSO: d=7.4 g/cm3; n=3 ; state=solid
        +el: name=Lutetium ; n=2
        +el: name=Silicon  ; n=1
        +el: name=Oxygen   ; n=5
Air: d=1.29 mg/cm3; n=1
        +el: name=Oxygen ; f=1.0
Epoxy: d=1.0 g/cm3; n=2
        +el: name=Hydrogen ; n=2
        +el: name=Oxygen   ; n=1
)";

constexpr const char* kMaterials = R"(<?xml version="1.0"?>
<materials>
  <material name="LSO"><propertiestable>
    <property name="SCINTILLATIONYIELD" value="26000" unit="1/MeV"/>
    <property name="SCINTILLATIONTIMECONSTANT1" value="40" unit="ns"/>
    <propertyvector name="SCINTILLATIONCOMPONENT1" energyunit="eV"><ve energy="2.95" value="1"/></propertyvector>
    <propertyvector name="ABSLENGTH" unit="m" energyunit="eV"><ve energy="1.84" value="50"/><ve energy="4.08" value="50"/></propertyvector>
    <propertyvector name="RINDEX" energyunit="eV"><ve energy="1.84" value="1.82"/><ve energy="4.08" value="1.82"/></propertyvector>
  </propertiestable></material>
  <material name="Air"><propertiestable>
    <propertyvector name="RINDEX" energyunit="eV"><ve energy="1.84" value="1"/><ve energy="4.08" value="1"/></propertyvector>
  </propertiestable></material>
</materials>
)";

constexpr const char* kSurfaces = R"(<?xml version="1.0"?>
<surfaces>
  <surface name="wrapped" type="dielectric_dielectric" sigmaalpha="6.0" finish="groundfrontpainted"><propertiestable>
    <propertyvector name="REFLECTIVITY" energyunit="eV"><ve energy="1.84" value="0.9"/><ve energy="4.08" value="0.9"/></propertyvector>
  </propertiestable></surface>
  <surface name="rough" type="dielectric_dielectric" sigmaalpha="6.0" finish="ground"><propertiestable>
    <propertyvector name="SPECULARLOBECONSTANT" energyunit="eV"><ve energy="1.84" value="1"/><ve energy="4.08" value="1"/></propertyvector>
  </propertiestable></surface>
  <surface name="diode" type="dielectric_metal" sigmaalpha="0" finish="polished"><propertiestable>
    <propertyvector name="REFLECTIVITY" energyunit="eV"><ve energy="1.84" value="0"/><ve energy="4.08" value="0"/></propertyvector>
    <propertyvector name="EFFICIENCY" energyunit="eV"><ve energy="1.84" value="1"/><ve energy="4.08" value="1"/></propertyvector>
  </propertiestable></surface>
</surfaces>
)";

void check_each(const std::string& text, const std::vector<std::string>& fragments) {
  for (const std::string& fragment : fragments) {
    CAPTURE(text);
    CAPTURE(fragment);
    CHECK(text.find(fragment) != std::string::npos);
  }
}

void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// A folder with the files of GATE, and the macro with further commands.
std::filesystem::path gate_macro(const std::string& more = {}, const std::string& surfaces = kSurfaces) {
  static int number = 0;
  const auto folder = scratch_folder("gate_" + std::to_string(++number));
  write(folder / "main.mac", kMacro + more);
  write(folder / "Materials.db", kDatabase);
  write(folder / "Materials.xml", kMaterials);
  write(folder / "Surfaces.xml", surfaces);
  return folder / "main.mac";
}

SceneDraft draft(const std::filesystem::path& macro) {
  gdml::GdmlImport options;
  options.mesh_folder = "meshes";
  return gate::draft_of_gate(macro, options);
}

SceneSpec written(const SceneDraft& scene) {
  static int number = 0;
  const auto file = scratch_folder("gate_scene_" + std::to_string(++number)) / "scene.toml";
  write_scene_draft(scene, file);
  return SceneFile::load(file).spec(0);
}

const PartSpec& part(const SceneSpec& spec, const std::string& name) {
  for (const PartSpec& known : spec.parts)
    if (known.name.name == name) return known;
  FAIL("no part " << name);
  throw InternalError("unreachable");
}

Vec3 place(const SceneSpec& spec, const std::string& name) { return part(spec, name).placement.translate; }

std::string complaint(const std::string& more, const std::string& surfaces = kSurfaces) {
  return complaint_of([&] { draft(gate_macro(more, surfaces)); });
}

}  // namespace

TEST_CASE("GATE: a macro with its materials and surfaces becomes a scene that runs") {
  const SceneDraft scene = draft(gate_macro());
  CHECK(scene.missing.empty());
  SceneSpec spec = written(scene);
  REQUIRE(spec.parts.size() == 3);
  CHECK(part(spec, "diode").sensor.name == "diode sensor");
  CHECK(part(spec, "diode").medium.name == "opaque");  // Epoxy has no entry in Materials.xml
  check_each(scene.toml, {"composition = { mass_fractions = { Lu = ", "density = { value = \"7.4 g/cm3\" }",
                          "leaving_first", "part = \"crystal*\""});
  spec.source.photons = 4000;
  const auto result = simulation::Simulation(spec).run_all();
  const auto& point = result.points[0];
  CHECK(point.fraction(Fate::detected).value > 0.05);
  // The face to the diode reflects nothing and detects all that it absorbs; the walls absorb the rest.
  CHECK(point.fraction(Fate::escaped).value == 0.0);
  CHECK(point.fraction(Fate::not_detected).value == 0.0);
  CHECK(point.fraction(Fate::cut_interactions).value == 0.0);
}

TEST_CASE("GATE: a surface is for light from the volume of the list to the inserted one, and not back") {
  const SceneDraft scene =
      draft(gate_macro("/gate/block/surfaces/insert crystal\n"
                       "/gate/block/surfaces/crystal/setSurface rough\n"));
  check_each(scene.toml, {"leaving_first = \"rough\"\nleaving_second = \"wrapped\""});
  check_each(scene.toml, {"for light from A to B, as GATE's source has it"});
}

TEST_CASE("GATE: sigmaalpha is in degrees, and every surface is of the unified model") {
  const SceneDraft scene =
      draft(gate_macro("/gate/block/surfaces/insert crystal\n"
                       "/gate/block/surfaces/crystal/setSurface rough\n"));
  check_each(scene.toml, {"sigma_alpha = \"0.104719755 rad\"", "base = \"geant4_ground\""});
}

TEST_CASE("GATE: cubicArray, linear, ring and genericRepeater place copies as GATE's repeaters do") {
  const std::string array =
      "/gate/crystal/repeaters/insert cubicArray\n/gate/crystal/cubicArray/setRepeatNumberX 3\n"
      "/gate/crystal/cubicArray/setRepeatNumberY 2\n/gate/crystal/cubicArray/setRepeatVector 2.5 3 0 mm\n";
  const SceneSpec cubic = written(draft(gate_macro(array)));
  CHECK(place(cubic, "crystal_0").isApprox(Vec3(-2.5, -1.5, 0)));
  CHECK(place(cubic, "crystal_4").isApprox(Vec3(0, 1.5, 0)));
  const SceneSpec corner =
      written(draft(gate_macro(array + "/gate/crystal/cubicArray/autoCenter false\n"
                                       "/gate/crystal/placement/setTranslation -3 -3 0 mm\n")));
  CHECK(place(corner, "crystal_0").isApprox(Vec3(-3, -3, 0)));

  const SceneSpec linear = written(
      draft(gate_macro("/gate/crystal/repeaters/insert linear\n/gate/crystal/linear/setRepeatNumber 2\n"
                       "/gate/crystal/linear/setRepeatVector 0 4 0 mm\n")));
  CHECK(place(linear, "crystal_1").isApprox(Vec3(0, 2, 0)));

  // A block at x = 50 on a ring about z: copy 1 of 4 lies at y = 50 and is turned with it, so that what was
  // at +x of its mother's axes is at +y.
  const SceneSpec ring = written(draft(
      gate_macro("/gate/block/placement/setTranslation 50 0 0 mm\n/gate/block/repeaters/insert ring\n"
                 "/gate/block/ring/setRepeatNumber 4\n/gate/crystal/placement/setTranslation 3 0 0 mm\n")));
  CHECK(place(ring, "block_1").isApprox(Vec3(0, 50, 0)));
  CHECK((place(ring, "crystal_2") - Vec3(0, 53, 0)).norm() < 1e-9);
  CHECK((place(ring, "crystal_3") - Vec3(-53, 0, 0)).norm() < 1e-9);

  const auto macro = gate_macro(
      "/gate/block/repeaters/insert genericRepeater\n"
      "/gate/block/genericRepeater/setPlacementsFilename list.txt\n");
  write(macro.parent_path() / "list.txt",
        "# copies\nTime s\nRotation deg\nTranslation mm\n0 0 0 0 1 100 0 0\n0 90 0 0 1 0 20 0\n");
  const SceneSpec generic = written(draft(macro));
  CHECK(place(generic, "block_1").isApprox(Vec3(0, 20, 0)));
  // The list's matrix turns the axes, so the body turns by -90 deg about z.
  const RotationSpec& turn = part(generic, "block_1").placement.rotate.at(0);
  CHECK(turn.axis.z() * turn.angle_rad == doctest::Approx(-90.0 * kDegree));
}

TEST_CASE("GATE: a placement turns a volume by its angle about its axis; alignToX lays z along x") {
  const SceneSpec spec = written(draft(gate_macro(
      "/gate/crystal/placement/setRotationAxis 0 0 2\n/gate/crystal/placement/setRotationAngle 30 deg\n"
      "/gate/block/placement/alignToX\n")));
  const auto& rotate = part(spec, "block").placement.rotate;
  REQUIRE(rotate.size() == 1);
  CHECK(rotate[0].axis.y() * rotate[0].angle_rad == doctest::Approx(90.0 * kDegree));
}

TEST_CASE("GATE: macros execute macros, aliases are replaced, a surface may have the world on one side") {
  const auto macro = gate_macro(
      "/control/alias side 4\n/control/execute more.mac\n/gate/block/surfaces/insert world\n"
      "/gate/block/surfaces/world/setSurface rough\n");
  write(macro.parent_path() / "more.mac", "/gate/diode/geometry/setXLength {side} mm  # narrower\n");
  const SceneDraft scene = draft(macro);
  const SceneSpec spec = written(scene);
  CHECK(part(spec, "diode").name.name == "diode");
  check_each(scene.toml, {"low = [\"-2 mm\", \"-4.5 mm\", \"-0.5 mm\"]", "name = \"world\""});
  CHECK(scene::SceneBuilder().build(spec).parts.size() == 4);
}

TEST_CASE("GATE: commands that are not converted are listed with place and effect, and vis is not") {
  const SceneDraft scene =
      draft(gate_macro("/gate/source/addSource s gps\n/gate/source/s/gps/particle gamma\n/vis/open OGL\n"
                       "/gate/crystal/vis/setColor red\n/gate/crystal/moves/insert rotation\n"));
  check_each(scene.toml,
             {"main.mac:32: /gate/source/addSource and 1 more such commands: sources are not converted",
              "main.mac:36: /gate/crystal/moves/insert: movement is not converted",
              "Materials.xml:6:6: SCINTILLATIONCOMPONENT1 of LSO is one line"});
  CHECK(scene.toml.find("OGL") == std::string::npos);
  CHECK(scene.toml.find("setColor") == std::string::npos);
}

TEST_CASE("GATE: errors state file and line, and what to do; all at once") {
  check_each(complaint("/gate/cristal/setMaterial LSO\n/gate/crystal/geometry/setXLength two mm\n"
                       "/gate/crystal/geometry/setYLength 2\n"),
             {"main.mac:32", "\"cristal\"", "crystal", "main.mac:33", "\"two\" is no number", "main.mac:34",
              "has no unit"});
  check_each(complaint("/gate/crystal/setMaterial LSOO\n"), {"\"LSOO\"", "LSO"});
  check_each(complaint("/gate/crystal/surfaces/to_air/setSurface wraped\n"),
             {"main.mac:32", "\"wraped\"", "wrapped"});
  check_each(complaint("/gate/crystal/surfaces/other/setSurface wrapped\n"),
             {"main.mac:32", "no surface \"other\"", "insert it first"});
  check_each(complaint("/gate/crystal/geometry/setRmax 2 mm\n"), {"main.mac:32", "is no dimension of a box"});
  check_each(complaint("/gate/block/daughters/insert trpd\n"), {"main.mac:32", "\"trpd\"", "cylinder"});
  check_each(complaint("/control/execute gone.mac\n"), {"main.mac:32", "gone.mac", "does not exist"});
  check_each(complaint("/control/execute main.mac\n"), {"50 deep"});
  check_each(complaint("/gate/crystal/setMaterial {stuff}\n"), {"main.mac:32", "alias", "\"stuff\""});
  check_each(complaint("/gate/crystal/repeaters/insert quadrant\n"),
             {"main.mac:32", "quadrant", "cubicArray"});
  std::string surfaces = kSurfaces;
  surfaces.replace(surfaces.find("energy=\"1.84\""), 13, "energy=\"-1.8\"");
  check_each(complaint("", surfaces), {"Surfaces.xml:4:", "REFLECTIVITY", "not above 0"});
  surfaces = kSurfaces;
  surfaces.replace(surfaces.find("value=\"0.9\""), 11, "value=\"much\"");
  check_each(complaint("", surfaces), {"Surfaces.xml:4:", "\"much\" is no number"});
}

TEST_CASE("GATE: what GATE takes otherwise than it is written is listed") {
  std::string surfaces = kSurfaces;
  surfaces.replace(surfaces.find("groundfrontpainted"), 18, "ground-front-painted");
  check_each(draft(gate_macro("", surfaces)).toml,
             {"Surfaces.xml:3:4: surface wrapped: finish \"ground-front-painted\" is not known to GATE, "
              "which takes polished"});
}

TEST_CASE("GATE: Materials.xml and Surfaces.xml of GATE 9 and 10 become definitions that a scene can hold") {
  for (const char* name : {"gate9/Materials.xml", "gate9/Surfaces.xml", "opengate/OpticalProperties.xml",
                           "opengate/SurfaceProperties.xml"}) {
    const auto file = shared_file(std::string("data/materials/") + name);
    if (!file) continue;
    CAPTURE(name);
    const SceneDraft definitions = gate::definitions_of_gate(*file, {});
    const auto path = scratch_folder("gate_definitions") / "scene.toml";
    write(
        path,
        "title = \"definitions\"\nambient = \"air\"\n" + definitions.toml +
            "\n[[part]]\nname = \"it\"\nbox = { low = [\"0 mm\", \"0 mm\", \"0 mm\"], high = [\"1 mm\", "
            "\"1 mm\", \"1 mm\"] }\nmedium = \"air\"\nsurface = \"polished\"\n[source]\ntype = \"photons\"\n"
            "region = { part = \"it\" }\nwavelength = \"420 nm\"\nphotons = 10\n");
    CHECK_NOTHROW(SceneFile::load(path).spec(0));
  }
}
