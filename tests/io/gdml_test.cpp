#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "io/gdml_texts.hpp"
#include "scintray/exchange/gdml/detail/solids.hpp"
#include "scintray/exchange/scene_draft.hpp"
#include "scintray/mesh/diagnosis.hpp"
#include "scintray/scene/build_scene.hpp"
#include "scintray/scene_file/read_scene.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::config;
using namespace scintray::mesh;
using namespace scintray::optics;
using namespace scintray::materials;
using namespace scintray::scene_file;
using namespace scintray::scene;
using namespace scintray::exchange;
using namespace scintray::test;

namespace {

std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

SceneDraft draft(const GdmlText& text, gdml::GdmlImport options = {}) {
  options.mesh_folder = "meshes";
  return gdml::draft_of_gdml(text.text(), "test.gdml", options);
}

/// What an import finds wrong: every error has a hint.
std::string complaint(const GdmlText& text) {
  for (const Problem& problem : problems_of([&] { draft(text); })) {
    CAPTURE(problem.what);
    CHECK_FALSE(problem.hint.empty());
  }
  return complaint_of([&] { draft(text); });
}

/// The scene of a draft, written and read back as a user would.
SceneSpec written(const SceneDraft& scene) {
  static int number = 0;
  const auto file = scratch_folder("gdml_" + std::to_string(++number)) / "scene.toml";
  write_scene_draft(scene, file);
  return SceneFile::load(file).spec(0);
}

BuiltScene built(const SceneDraft& scene) { return SceneBuilder().build(written(scene)); }

}  // namespace

TEST_CASE("GDML: tessellated solids and tetrahedra take their corners from <define>, in any rotation") {
  GdmlText text = gdml_solid(R"(<tessellated name="it"><triangular vertex1="a" vertex2="b" vertex3="d"/>
<triangular vertex1="b" vertex2="c" vertex3="d"/><triangular vertex1="a" vertex2="c" vertex3="d"/>
<triangular vertex1="a" vertex2="b" vertex3="c"/></tessellated>)");
  text.define = R"(<position name="a"/><position name="b" x="1" unit="cm"/><position name="c" y="20"/>
<position name="d" z="30"/>)";
  const SceneDraft tessellated = draft(text);
  REQUIRE(tessellated.meshes.size() == 1);
  CHECK(diagnose(tessellated.meshes.begin()->second).sound());
  CHECK(tessellated.meshes.begin()->second.volume() == doctest::Approx(1000.0));
  text.solids = R"(<tet name="it" vertex1="a" vertex2="b" vertex3="c" vertex4="d"/>)";
  CHECK(draft(text).meshes.begin()->second.volume() == doctest::Approx(1000.0));
  text.solids = R"(<tet name="it" vertex1="a" vertex2="b" vertex3="c" vertex4="e"/>)";
  check_contains(complaint(text), {"no position", "\"e\""});
}

TEST_CASE("GDML: a physical volume is turned by the inverse of its rotation, then moved") {
  GdmlText text = gdml_solid(R"(<box name="it" x="10" y="2" z="2"/>)");
  text.structure += gdml_volume("marker", "it", "Lead");
  text.daughters = gdml_placed("p", "body", R"(<position x="100" unit="mm"/><rotation z="30" unit="deg"/>)");
  const BuiltScene scene = built(draft(text));
  REQUIRE(scene.parts.size() == 1);
  // Turned by -30 deg: the far end in +x lies at -y.
  const SceneSpec spec = written(draft(text));
  REQUIRE(spec.parts[0].placement.rotate.size() == 1);
  const RotationSpec& turn = spec.parts[0].placement.rotate[0];
  CHECK(turn.axis.z() * turn.angle_rad == doctest::Approx(-30.0 * kDegree));
  CHECK(spec.parts[0].placement.translate.isApprox(Vec3(100, 0, 0)));
}

TEST_CASE("GDML: nested and repeated volumes, assemblies, replicas, loops and mirrored copies are placed") {
  GdmlText text;
  text.define = "<variable name=\"i\" value=\"0\"/>";
  text.solids = R"(<box name="small" x="2" y="2" z="2"/><box name="tray" x="40" y="10" z="10"/>
<tube name="wedge" rmax="2" z="2" startphi="0" deltaphi="1.2"/><box name="row" x="12" y="3" z="3"/>)";
  text.structure =
      gdml_volume("crystal", "small") + gdml_volume("wedge_v", "wedge") + R"(<assembly name="pair">)" +
      gdml_placed("left", "crystal", R"(<position x="-5"/>)") +
      gdml_placed("right", "crystal", R"(<position x="5"/>)") + "</assembly>\n" +
      gdml_volume("tray_v", "tray", "Vacuum",
                  gdml_placed("pair_phys", "pair", R"(<position y="3"/>)") +
                      R"(<loop for="i" from="0" to="2" step="1">)" +
                      gdml_placed("looped[i]", "crystal", R"(<position x="3*i-3" y="-3"/>)") + "</loop>") +
      gdml_volume("row_v", "row", "Vacuum",
                  R"(<replicavol number="4"><volumeref ref="crystal"/><replicate_along_axis>
<direction x="1"/><width value="3" unit="mm"/><offset value="0" unit="mm"/></replicate_along_axis></replicavol>)");
  text.daughters = gdml_placed("t1", "tray_v", R"(<position z="20"/>)") +
                   gdml_placed("t2", "tray_v", R"(<position z="-20"/><rotation z="90" unit="deg"/>)") +
                   gdml_placed("r", "row_v", R"(<position z="60"/>)") +
                   gdml_placed("w", "wedge_v", R"(<position y="50"/>)") +
                   gdml_placed("m", "wedge_v", R"(<position y="-50"/><scale x="1" y="1" z="-1"/>)");
  const SceneDraft scene = draft(text);
  CHECK(scene.missing.empty());
  CHECK(scene.meshes.size() == 2);  // the wedge and its mirror image
  const SceneSpec spec = written(scene);
  CHECK(spec.parts.size() == 2 * (1 + 2 + 3) + 1 + 4 + 2);
  std::vector<std::string> names;
  for (const PartSpec& part : spec.parts) names.push_back(part.name.name);
  CHECK(std::count(names.begin(), names.end(), "left") == 1);
  CHECK(std::count(names.begin(), names.end(), "left_2") == 1);
  CHECK(std::count(names.begin(), names.end(), "looped_1") == 1);
  const auto looped = std::find_if(spec.parts.begin(), spec.parts.end(),
                                   [](const PartSpec& part) { return part.name.name == "looped_2"; });
  CHECK(looped->placement.translate.isApprox(Vec3(3, -3, 20)));
  // In the tray that is turned by -90 deg, (3, -3) goes to (-3, -3).
  const auto turned = std::find_if(spec.parts.begin(), spec.parts.end(),
                                   [](const PartSpec& part) { return part.name.name == "looped_2_2"; });
  CHECK(turned->placement.translate.isApprox(Vec3(-3, -3, -20)));
  CHECK(built(scene).parts.size() == spec.parts.size());
}

TEST_CASE("GDML: replicas about z and divisions of a box lie where Geant4 has them") {
  GdmlText text;
  text.solids = R"(<box name="slab" x="12" y="3" z="3"/><box name="piece" x="3" y="3" z="3"/>
<tube name="ring" rmin="5" rmax="8" z="3" deltaphi="360" aunit="deg"/>
<tube name="sector" rmin="5" rmax="8" z="3" startphi="-45" deltaphi="90" aunit="deg"/>)";
  text.structure = gdml_volume("piece_v", "piece") + gdml_volume("sector_v", "sector") +
                   gdml_volume("slab_v", "slab", "Vacuum",
                               R"(<divisionvol axis="kXAxis" number="3" width="3" offset="3" unit="mm">
<volumeref ref="piece_v"/></divisionvol>)") +
                   gdml_volume("ring_v", "ring", "Vacuum",
                               R"(<replicavol number="4"><volumeref ref="sector_v"/><replicate_along_axis>
<direction phi="1"/><width value="90" unit="deg"/><offset value="0" unit="deg"/></replicate_along_axis></replicavol>)");
  text.daughters = gdml_placed("s", "slab_v") + gdml_placed("r", "ring_v", R"(<position z="20"/>)");
  const SceneSpec spec = written(draft(text));
  REQUIRE(spec.parts.size() == 2 + 3 + 4);
  const auto part = [&](const char* name) -> const PartSpec& {
    return *std::find_if(spec.parts.begin(), spec.parts.end(),
                         [&](const PartSpec& known) { return known.name.name == name; });
  };
  CHECK(part("piece_v_0").placement.translate.isApprox(Vec3(-1.5, 0, 0)));
  CHECK(part("piece_v_2").placement.translate.isApprox(Vec3(4.5, 0, 0)));
  const RotationSpec& turn = part("sector_v_1").placement.rotate.at(0);
  CHECK(turn.axis.z() * turn.angle_rad == doctest::Approx(135.0 * kDegree));
  CHECK(built(draft(text)).parts.size() == 9);
  const std::string before = text.structure;
  text.structure.replace(text.structure.find("width=\"3\""), 9, "width=\"4\"");
  check_contains(complaint(text), {"extend to 15.000000", "12.000000"});
  text.structure = before;
  text.structure.replace(text.structure.find("kXAxis"), 6, "kPhi");
  check_contains(complaint(text), {"divisions other than along kXAxis"});
}

TEST_CASE("GDML: the copies of a division have its dimensions, whatever their own solid has") {
  // Each row: the mother's solid, the axis with number and offset, and the volume of a copy.
  struct Case {
    const char* solid;
    const char* division;
    double first, last;
    int number;
  };
  const double round = 0.004;
  const Case cases[] = {
      {R"(<box name="it" x="12" y="3" z="4"/>)", R"(axis="kXAxis" number="4" unit="mm")", 36, 36, 4},
      {R"(<box name="it" x="12" y="3" z="4"/>)", R"(axis="kZAxis" width="0.15" offset="0.1" unit="cm")", 54,
       54, 2},
      {R"(<tube name="it" rmin="2" rmax="6" z="10" deltaphi="360" aunit="deg"/>)",
       R"(axis="kRho" number="2" unit="mm")", kPi * (16 - 4) * 10, kPi * (36 - 16) * 10, 2},
      {R"(<tube name="it" rmin="2" rmax="6" z="10" startphi="20" deltaphi="180" aunit="deg"/>)",
       R"(axis="kPhi" number="3" unit="deg")", kPi * 32 * 10 / 6, kPi * 32 * 10 / 6, 3},
      {R"(<cone name="it" rmin1="0" rmax1="2" rmin2="0" rmax2="6" z="8" deltaphi="360" aunit="deg"/>)",
       R"(axis="kZAxis" number="2" unit="mm")", kPi * 4 / 3 * (4 + 16 + 8), kPi * 4 / 3 * (16 + 36 + 24), 2},
      {R"(<trd name="it" x1="2" x2="4" y1="3" y2="3" z="6"/>)", R"(axis="kZAxis" number="2" unit="mm")",
       2.5 * 9, 3.5 * 9, 2},
      {R"(<trd name="it" x1="2" x2="4" y1="3" y2="3" z="6"/>)", R"(axis="kXAxis" number="3" unit="mm")", 18,
       18, 3},
      {R"(<para name="it" x="6" y="4" z="3" alpha="10" theta="20" phi="30" aunit="deg"/>)",
       R"(axis="kYAxis" number="4" unit="mm")", 18, 18, 4},
      {R"(<polycone name="it" deltaphi="360" aunit="deg"><zplane z="0" rmin="0" rmax="4"/>
<zplane z="5" rmin="0" rmax="4"/></polycone>)",
       R"(axis="kPhi" number="4" unit="deg")", kPi * 20, kPi * 20, 4},
      {R"(<polyhedra name="it" numsides="4" deltaphi="360" aunit="deg"><zplane z="0" rmax="2"/>
<zplane z="7" rmax="2"/></polyhedra>)",
       R"(axis="kRho" number="2" unit="mm")", 4 * 7, 12 * 7, 2},
  };
  for (const Case& c : cases) {
    CAPTURE(c.solid);
    CAPTURE(c.division);
    GdmlText text;
    text.solids = std::string(c.solid) + R"(<box name="other" x="1" y="1" z="1"/>)";
    text.structure =
        gdml_volume("piece", "other") +
        gdml_volume("mother", "it", "Vacuum",
                    "<divisionvol " + std::string(c.division) + "><volumeref ref=\"piece\"/></divisionvol>");
    text.daughters = gdml_placed("m", "mother");
    const BuiltScene scene = built(draft(text));
    REQUIRE(scene.scene.parts.size() == 1 + static_cast<std::size_t>(c.number));
    CHECK(scene.placed[1].mesh.volume() == doctest::Approx(c.first).epsilon(round));
    CHECK(scene.placed[static_cast<std::size_t>(c.number)].mesh.volume() ==
          doctest::Approx(c.last).epsilon(round));
    // The copies lie in the mother, side by side: no part overlaps another, or the scene would not be built.
    CHECK(scene.scene.regions.size() >= scene.scene.parts.size());
  }
}

TEST_CASE("GDML: replicas along rho are rings, and parameterised volumes have dimensions of their own") {
  GdmlText text;
  text.define = "<variable name=\"i\" value=\"0\"/>";
  text.solids = R"(<tube name="disc" rmax="9" z="4" deltaphi="360" aunit="deg"/>
<tube name="ring" rmax="3" z="4" deltaphi="360" aunit="deg"/><box name="tray" x="40" y="40" z="10"/>
<box name="cell" x="1" y="1" z="1"/>)";
  text.structure = gdml_volume("ring_v", "ring") + gdml_volume("cell_v", "cell") +
                   gdml_volume("disc_v", "disc", "Vacuum",
                               R"(<replicavol number="3"><volumeref ref="ring_v"/><replicate_along_axis>
<direction rho="1"/><width value="3" unit="mm"/><offset value="0" unit="mm"/></replicate_along_axis></replicavol>)") +
                   gdml_volume("tray_v", "tray", "Vacuum", R"(<paramvol ncopies="4"><volumeref ref="cell_v"/>
<parameterised_position_size><loop for="i" to="2" step="1"><parameters number="i"><position x="10*i-10" y="-5"/>
<box_dimensions x="i+1" y="2" z="3" lunit="mm"/></parameters></loop>
<parameters number="3"><position y="10"/><rotation z="90" unit="deg"/><box_dimensions x="1.2" y="0.2" z="0.4" lunit="cm"/>
</parameters></parameterised_position_size></paramvol>)");
  text.daughters = gdml_placed("d", "disc_v") + gdml_placed("t", "tray_v", R"(<position z="50"/>)");
  const BuiltScene scene = built(draft(text));
  const auto volume = [&](const std::string& name) {
    for (const PartInfo& part : scene.scene.parts)
      if (part.name == name) return part.volume_mm3;
    return 0.0;
  };
  for (int copy = 0; copy < 3; ++copy)
    CHECK(volume("ring_v_" + std::to_string(copy)) ==
          doctest::Approx(kPi * 9 * (2 * copy + 1) * 4).epsilon(0.004));
  for (int copy = 0; copy < 3; ++copy)
    CHECK(volume("cell_v_" + std::to_string(copy)) == doctest::Approx(6.0 * (copy + 1)));
  CHECK(volume("cell_v_3") == doctest::Approx(12 * 2 * 4));
  const SceneSpec spec = written(draft(text));
  const auto last = std::find_if(spec.parts.begin(), spec.parts.end(),
                                 [](const PartSpec& part) { return part.name.name == "cell_v_3"; });
  CHECK(last->placement.translate.isApprox(Vec3(0, 10, 50)));
  CHECK(last->placement.rotate.at(0).axis.z() * last->placement.rotate.at(0).angle_rad ==
        doctest::Approx(-0.5 * kPi));
  text.structure.replace(text.structure.find("<box_dimensions x=\"i+1\""), 23, "<box_dimensions x=\"i-1\"");
  check_contains(complaint(text), {"(box)", "above 0"});
}

TEST_CASE("GDML: boxes made in a loop have the dimensions of their step; facets and tetrahedra take a unit") {
  GdmlText text;
  text.define =
      R"(<variable name="i" value="0"/><position name="a"/><position name="b" x="30"/><position name="c" y="20"/>
<position name="d" z="30"/>)";
  text.solids = R"(<loop for="i" from="1" to="2" step="1"><box name="b[i]" x="i" y="2*i" z="3"/></loop>
<tet name="t" lunit="cm" vertex1="a" vertex2="b" vertex3="c" vertex4="d"/>)";
  text.structure = gdml_volume("one", "b_1") + gdml_volume("two", "b_2") + gdml_volume("three", "t");
  text.daughters = gdml_placed("p1", "one") + gdml_placed("p2", "two", R"(<position x="20"/>)") +
                   gdml_placed("p3", "three", R"(<position x="50"/>)");
  const BuiltScene scene = built(draft(text));
  REQUIRE(scene.scene.parts.size() == 3);
  CHECK(scene.scene.parts[PartId(0)].volume_mm3 == doctest::Approx(1 * 2 * 3));
  CHECK(scene.scene.parts[PartId(1)].volume_mm3 == doctest::Approx(2 * 4 * 3));
  // Positions are in mm already; Geant4 multiplies them by the unit of the solid.
  CHECK(scene.scene.parts[PartId(2)].volume_mm3 == doctest::Approx(3000.0 * 1000.0));
}

TEST_CASE("GDML: tables of other programs' properties are listed, whatever their energies are") {
  GdmlText text = gdml_solid(R"(<box name="it" x="3" y="3" z="3"/>)");
  text.define = R"(<matrix name="own" coldim="2" values="0 6 1 7"/>)";
  text.materials = R"(<material name="Argon"><property name="RINDEX" ref="N15"/>
<property name="GammaFASTTIMECONSTANT" ref="own"/><D value="1.4"/></material>)";
  text.structure = gdml_volume("body", "it", "Argon");
  const SceneDraft scene = draft(text);
  CHECK(std::any_of(scene.notes.begin(), scene.notes.end(), [](const std::string& note) {
    return contains(note, "no counterpart here: GammaFASTTIMECONSTANT");
  }));
  text.materials.replace(text.materials.find("GammaFAST"), 21, "ABSLENGTH");
  check_contains(complaint(text), {"ABSLENGTH", "not above 0"});
}

TEST_CASE("GDML: corners of a facet of the type RELATIVE count from its first") {
  GdmlText text =
      gdml_solid(R"(<tessellated name="it"><triangular type="RELATIVE" vertex1="o" vertex2="b" vertex3="c"/>
<triangular type="RELATIVE" vertex1="o" vertex2="c" vertex3="d"/>
<triangular type="RELATIVE" vertex1="o" vertex2="d" vertex3="b"/>
<triangular vertex1="ob" vertex2="oc" vertex3="od"/></tessellated>)");
  text.define =
      R"(<position name="o" x="5" y="6" z="7"/><position name="b" x="30"/><position name="c" y="20"/>
<position name="d" z="10"/><position name="ob" x="35" y="6" z="7"/><position name="oc" x="5" y="26" z="7"/>
<position name="od" x="5" y="6" z="17"/>)";
  CHECK(draft(text).meshes.begin()->second.volume() == doctest::Approx(1000.0));
}

TEST_CASE("GDML: a world without volumes is named, with the volumes that are placed nowhere") {
  GdmlText text = gdml_solid(R"(<box name="it" x="3" y="3" z="3"/>)");
  text.daughters.clear();
  const SceneDraft scene = draft(text);
  REQUIRE_FALSE(scene.missing.empty());
  check_contains(scene.missing.front(), {"no parts", "\"World\"", "body"});
}

TEST_CASE(
    "GDML: materials become media; energies become wavelengths, per-energy spectra per-wavelength ones") {
  GdmlText text = gdml_solid(R"(<box name="it" x="10" y="2" z="2"/>)");
  text.define = R"(<matrix name="ABS" coldim="2" values="2.5*eV 50*cm 3*eV 20*cm"/>
<matrix name="FLAT" coldim="2" values="2.5*eV 1 3*eV 1"/><constant name="YIELD" value="8000/MeV"/>
<matrix name="T1" coldim="1" values="40*ns"/><matrix name="T2" coldim="1" values="200*ns"/>
<matrix name="Y1" coldim="1" values="3"/><matrix name="Y2" coldim="1" values="1"/>)";
  text.materials = R"(<material name="LSO0x7f12"><property name="RINDEX" ref="N15"/>
<property name="ABSLENGTH" ref="ABS"/><property name="RAYLEIGH" ref="ABS"/>
<property name="SCINTILLATIONYIELD" ref="YIELD"/><property name="SCINTILLATIONCOMPONENT1" ref="FLAT"/>
<property name="SCINTILLATIONCOMPONENT2" ref="FLAT"/><property name="SCINTILLATIONTIMECONSTANT1" ref="T1"/>
<property name="SCINTILLATIONTIMECONSTANT2" ref="T2"/><property name="SCINTILLATIONYIELD1" ref="Y1"/>
<property name="SCINTILLATIONYIELD2" ref="Y2"/><property name="BIRKSCONSTANT" ref="T1"/><D value="7.4"/></material>
)";
  text.structure = gdml_volume("body", "it", "LSO0x7f12");
  const SceneDraft scene = draft(text);
  CHECK(scene.missing.empty());
  check_contains(scene.toml, "no counterpart here: BIRKSCONSTANT");
  const SceneSpec spec = written(scene);
  MaterialDatabase database = MaterialDatabase::shipped();
  add_definitions(database, spec);
  const Medium medium = database.medium("LSO0x7f12", {});
  const double nm = 1239.841984 / 3.0;
  // Straight over energy; the points between are 2 % apart, which leaves a quarter of that of their step.
  CHECK(std::abs(medium.index(nm) - 1.5) < 0.02 / 4.0 * (0.2 / 34.0));
  CHECK(medium.absorption_per_mm(nm) == doctest::Approx(1.0 / 200.0));
  // Beyond its table Geant4 goes on with the last value.
  CHECK(medium.absorption_per_mm(1239.841984 / 2.1) == doctest::Approx(1.0 / 500.0));
  CHECK(medium.scattering == ScatteringKind::rayleigh);
  CHECK(medium.yield_per_keV == doctest::Approx(8.0));
  CHECK(medium.density_g_per_cm3 == doctest::Approx(7.4));
  REQUIRE(medium.decay.size() == 2);
  CHECK(medium.decay[0].fraction == doctest::Approx(0.75));
  CHECK(medium.decay[1].decay_ns == doctest::Approx(200.0));
  // Flat per energy falls as 1 / wavelength^2.
  CHECK(medium.emission(1239.841984 / 3.0) / medium.emission(1239.841984 / 2.5) ==
        doctest::Approx(9.0 / 6.25));
  CHECK(std::get<RegionSpec>(spec.source.origin).part.name == "body_phys");
  CHECK_FALSE(spec.source.wavelength_nm.has_value());
  CHECK_NOTHROW(built(scene));
}

TEST_CASE("GDML: a material without RINDEX is opaque, unless the user sets a medium") {
  GdmlText text = gdml_solid(R"(<box name="it" x="10" y="2" z="2"/>)");
  text.structure = gdml_volume("body", "it", "Lead");
  const SceneDraft opaque = draft(text);
  check_contains(opaque.toml, "medium = \"opaque\"  # material Lead has no RINDEX");
  REQUIRE(opaque.missing.size() == 1);
  check_contains(opaque.missing[0], "[source]");
  gdml::GdmlImport options;
  options.media["Lead"] = "BGO";
  const SceneDraft given = draft(text, options);
  CHECK(given.missing.empty());
  CHECK(written(given).parts[0].medium.name == "BGO");
  options.media["Led"] = "BGO";
  check_contains(complaint_of([&] { draft(text, options); }), "does not have");
}

TEST_CASE("GDML: skins, borders and Geant4's finishes become surfaces and contacts") {
  GdmlText text;
  text.define = R"(<matrix name="R95" coldim="2" values="2*eV 0.95 4*eV 0.95"/>
<matrix name="T04" coldim="2" values="2*eV 0.04 4*eV 0.04"/><matrix name="LOBE" coldim="2" values="2*eV 0.7 4*eV 0.7"/><matrix name="GAP" coldim="2" values="2*eV 1.1 4*eV 1.1"/>)";
  text.solids = R"(<box name="it" x="10" y="10" z="10"/>
<opticalsurface name="rough" model="unified" finish="ground" type="dielectric_dielectric" value="0.2">
<property name="SPECULARLOBECONSTANT" ref="LOBE"/></opticalsurface>
<opticalsurface name="wrapped" model="1" finish="5" type="1" value="0"><property name="RINDEX" ref="GAP"/>
<property name="REFLECTIVITY" ref="R95"/></opticalsurface>
<opticalsurface name="mirror" model="glisur" finish="polished" type="dielectric_metal" value="1">
<property name="REFLECTIVITY" ref="R95"/><property name="TRANSMITTANCE" ref="T04"/></opticalsurface>
<opticalsurface name="white" model="unified" finish="ground" type="dielectric_metal" value="0.1">
<property name="REFLECTIVITY" ref="R95"/><property name="TRANSMITTANCE" ref="T04"/></opticalsurface>
<opticalsurface name="davis" model="3" finish="30" type="3" value="0"/>
<opticalsurface name="edge" model="4" finish="0" type="dielectric_dichroic" value="0"/>)";
  text.structure = gdml_volume("a", "it") + gdml_volume("b", "it") + gdml_volume("c", "it") +
                   gdml_volume("d", "it") +
                   R"(<skinsurface name="s1" surfaceproperty="rough"><volumeref ref="a"/></skinsurface>
<skinsurface name="s2" surfaceproperty="wrapped"><volumeref ref="b"/></skinsurface>
<skinsurface name="s3" surfaceproperty="white"><volumeref ref="c"/></skinsurface>
<bordersurface name="s4" surfaceproperty="mirror"><physvolref ref="pa"/><physvolref ref="pd"/></bordersurface>)";
  text.daughters = gdml_placed("pa", "a") + gdml_placed("pb", "b", R"(<position z="30"/>)") +
                   gdml_placed("pc", "c", R"(<position z="60"/>)") +
                   gdml_placed("pd", "d", R"(<position x="10"/>)");
  const SceneDraft scene = draft(text);
  check_contains(scene.toml, "between = [\"pa\", \"pd\"]");
  const SceneSpec spec = written(scene);
  CHECK(spec.parts[0].surface.name == "rough");
  CHECK(spec.parts[3].surface.empty());  // no skin: light interacts with that of the part it comes from
  CHECK(spec.contacts_default == ContactKind::each_side);
  REQUIRE(spec.contacts.size() == 1);
  CHECK(spec.contacts[0].leaving[0].name == "mirror");
  CHECK(spec.contacts[0].leaving[1].empty());
  const TomlNodePtr rough = spec.surfaces.at("rough");
  CHECK(rough->find("base")->text == "geant4_ground");
  CHECK(rough->find("unified")->find("lobe")->number == doctest::Approx(0.7));
  CHECK(rough->find("unified")->find("sigma_alpha")->text == "0.2 rad");
  CHECK(spec.surfaces.at("wrapped")->find("base")->text == "geant4_groundbackpainted");
  CHECK(spec.surfaces.at("wrapped")->find("gap")->number == doctest::Approx(1.1));
  CHECK(spec.surfaces.at("mirror")->find("base")->text == "geant4_polishedfrontpainted");
  CHECK(spec.surfaces.at("white")->find("base")->text == "geant4_groundfrontpainted");
  // Light that passes goes straight on in Geant4, undeflected, whatever the finish.
  for (const char* name : {"mirror", "white"}) {
    CHECK(spec.surfaces.at(name)->find("undeflected"));
    CHECK(spec.surfaces.at(name)->find("admitted"));
    CHECK(spec.surfaces.at(name)->find("reflectance")->number == 1.0);
  }
  CHECK_NOTHROW(built(scene));

  const std::string without_skin = text.structure;
  text.structure += R"(<skinsurface name="s5" surfaceproperty="davis"><volumeref ref="d"/></skinsurface>)";
  const SceneDraft tabulated = draft(text);
  CHECK(tabulated.missing.empty());
  const TomlNodePtr davis = written(tabulated).surfaces.at("davis");
  CHECK(davis->find("model")->text == "geant4_table");
  CHECK(davis->find("geant4_table")->find("finish")->text == "Rough_LUT");  // number 30 of G4SurfaceFinish

  text.structure =
      without_skin + R"(<skinsurface name="s5" surfaceproperty="edge"><volumeref ref="d"/></skinsurface>)";
  const SceneDraft table = draft(text);
  CHECK(table.missing.empty());
  check_contains(table.toml, {"transmitted = \"undeflected\"", "geant4_dichroic = {}"});
  gdml::GdmlImport options;
  options.surfaces["edge"] = "polished";
  CHECK(written(draft(text, options)).parts[3].surface.name == "polished");
}

TEST_CASE(
    "GDML: the copies of two volumes have a contact within each of their mothers, and too many are refused") {
  GdmlText text;
  text.solids = R"(<box name="it" x="4" y="4" z="4"/><box name="block" x="4" y="4" z="8"/>
<opticalsurface name="mirror" model="glisur" finish="polished" type="dielectric_metal" value="1"/>)";
  const auto border = [](const std::string& from, const std::string& to) {
    return "<bordersurface name=\"s\" surfaceproperty=\"mirror\"><physvolref ref=\"" + from +
           "\"/><physvolref ref=\"" + to + "\"/></bordersurface>\n";
  };
  const std::string structure = gdml_volume("a", "it") + gdml_volume("b", "it") +
                                gdml_volume("block_v", "block", "Vacuum",
                                            gdml_placed("pa", "a", R"(<position z="-2"/>)") +
                                                gdml_placed("pb", "b", R"(<position z="2"/>)"));
  const auto blocks = [](const std::string& last) {
    return "<loop for=\"i\" to=\"" + last + "\" step=\"1\">" +
           gdml_placed("one[i]", "block_v", R"(<position x="4*i"/>)") + "</loop>";
  };
  text.structure = structure + border("pa", "pb") + border("one_0", "pb");
  text.daughters = blocks("2");
  const SceneSpec spec = written(draft(text));
  REQUIRE(spec.parts.size() == 9);
  const auto mother = [&](std::size_t part) { return spec.parts.at(part).placement.translate.x(); };
  std::size_t between_blocks = 0, with_block = 0;
  const auto part_of = [&](const std::string& name) {
    return static_cast<std::size_t>(
        std::find_if(spec.parts.begin(), spec.parts.end(),
                     [&](const PartSpec& known) { return known.name.name == name; }) -
        spec.parts.begin());
  };
  for (const ContactSpec& contact : spec.contacts) {
    const std::size_t first = part_of(contact.between[0].name), second = part_of(contact.between[1].name);
    between_blocks += mother(first) != mother(second);
    with_block += contact.between[0].name.starts_with("one");
  }
  CHECK(spec.contacts.size() == 3 + 1);
  CHECK(between_blocks == 0);
  CHECK(with_block == 1);

  text.structure = structure;
  for (int i = 0; i < 5001; ++i) text.structure += border("pa", "pb");
  text.daughters = blocks("199");
  check_contains(complaint(text), {"test.gdml:5022:2: error:", "more than 1000000 pairs of volumes"});
  check_contains(complaint(text), "use a skin surface");
}

TEST_CASE("GDML: what cannot be done is refused with its name and line") {
  const auto of = [](const std::string& solid_text) { return complaint(gdml_solid(solid_text)); };
  check_contains(of(R"(<knot name="it" x="3" y="3" z="3"/>)"),
                 {"test.gdml:14:2: error:", "solid \"it\" (knot)", "cannot be made"});
  check_contains(of(R"(<twistedbox name="it" PhiTwist="2" x="3" y="3" z="3"/>)"),
                 {"solid \"it\" (twistedbox)", "-90 and 90"});
  check_contains(
      of(R"(<cutTube name="it" rmax="5" z="2" deltaphi="360" aunit="deg" lowX="0" lowY="0" lowZ="-1"
highX="-1" highY="0" highZ="1"/>)"),
      "meet within the tube");
  check_contains(of(R"(<multiUnion name="it"/>)"), "no <multiUnionNode>");
  check_contains(of(R"(<box name="it" x="3" y="3"/>)"), {"\"z\"", "missing", "above 0"});
  check_contains(of(R"(<box name="it" x="3*(" y="3" z="3"/>)"), "cannot evaluate \"3*(\"");
  check_contains(of(R"(<box name="it" x="LENGTH" y="3" z="3"/>)"), "cannot evaluate \"LENGTH\"");
  check_contains(of(R"(<box name="it" lunit="ell" x="3" y="3" z="3"/>)"), "cannot evaluate \"ell\"");
  check_contains(of(R"(<union name="it"><first ref="it"/><second ref="world_box"/></union>)"),
                 "contains itself");
  check_contains(of(R"(<union name="it"><first ref="gone"/><second ref="world_box"/></union>)"),
                 {"no solid", "\"gone\""});
  check_contains(of(R"(<tube name="it" rmin="5" rmax="4" z="1" deltaphi="6"/>)"),
                 {"rmin", "between 0 and rmax"});
  check_contains(of(R"(<box name="it" x="1" y="1" z="4" lunit="1e6*m"/>)"),
                 {"test.gdml:14:2: error:", "larger than 1000 km"});
  check_contains(of(R"(<tube name="it" rmax="0.005" z="5e5" deltaphi="360" aunit="deg"/>)"),
                 "no volume within rounding");
  check_contains(of(R"(<intersection name="it"><first ref="world_box"/><second ref="world_box"/>
<position x="5" unit="m"/></intersection>)"),
                 {"nothing", "boolean"});

  GdmlText text = gdml_solid(R"(<box name="it" x="3" y="3" z="3"/>)");
  text.structure += R"(<volume name="loop"><materialref ref="Glass"/><solidref ref="it"/>)" +
                    gdml_placed("p", "loop") + "</volume>";
  text.daughters += gdml_placed("q", "loop");
  check_contains(complaint(text), "placed inside itself");
  text.daughters = gdml_placed("q", "gone");
  check_contains(complaint(text), {"no volume", "\"gone\""});
  text.daughters.clear();
  text.define = R"(<loop for="i" from="0" to="1e9" step="1"><constant name="c" value="1"/></loop>)";
  check_contains(complaint(text), "over 200000 steps");
  text.define.clear();
  text.daughters = R"(<loop for="i" from="1" to="1e12" step="1">)" + gdml_placed("p", "body") + "</loop>";
  check_contains(complaint(text), {"test.gdml", "over 200000 steps"});
  text.daughters.clear();
  text.define = R"(<matrix name="m" coldim="2" values="1 2 3"/>)";
  check_contains(complaint(text), {"not fill", "2 columns"});

  const auto whole = [](const std::string& content) {
    return complaint_of([&] { gdml::draft_of_gdml(content, "test.gdml", {}); });
  };
  check_contains(whole("<gdml><solids>"), "not well-formed");
  check_contains(whole("hello"), "test.gdml");
  check_contains(whole("<gdml/>"), "no <solids>");
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "<a>";
  check_contains(whole(deep), {"nested", "500 deep"});
}

TEST_CASE("GDML: volumes with solids that cannot be made are left out on demand, with a note") {
  GdmlText text = gdml_solid(R"(<knot name="it" x="3" y="3" z="3"/>)");
  text.solids += R"(<box name="other" x="3" y="3" z="3"/>)";
  text.structure += gdml_volume("kept", "other");
  text.daughters += gdml_placed("kept_phys", "kept");
  gdml::GdmlImport options;
  options.skip_unsupported = true;
  const SceneDraft scene = draft(text, options);
  REQUIRE(scene.notes.size() == 1);
  check_contains(scene.notes[0], "volume body: solid \"it\" (knot)");
  CHECK(written(scene).parts.size() == 1);
}

TEST_CASE("Geant4's own GDML files become scenes that are built, or that name what is missing") {
  struct Case {
    const char* name;
    gdml::GdmlImport options;
    std::size_t parts;
  };
  std::vector<Case> cases(5);
  cases[0] = {"tess.gdml", {}, 2};
  cases[0].options.media["AirinTest"] = "air";
  cases[1] = {"opticalsurfaces.gdml", {}, 2};
  cases[2] = {"solids.gdml", {}, 26};  // its four twisted solids included
  cases[2].options.media = {{"Water", "glass"}, {"Air", "air"}};
  cases[2].options.skip_unsupported = true;
  cases[2].options.tessellation = {0.5, 15.0 * kDegree};
  cases[3] = {"NoviceExample.gdml", {}, 3};
  cases[3].options.surfaces["WaterSurface"] = "geant4_polished";
  cases[4] = {"homogeneous_pbwo_crystalcal.gdml", {}, 1};
  cases[4].options.media = {{"PbWO4", "glass"}, {"AIR", "air"}};
  for (Case& c : cases) {
    CAPTURE(c.name);
    const auto path = shared_file(std::string("data/meshes/geant4_gdml/") + c.name);
    if (!path) return;
    c.options.mesh_folder = "meshes";
    const SceneDraft scene = gdml::draft_of_gdml(read_text(*path), path->string(), c.options);
    CHECK(scene.missing.empty());
    CHECK(built(scene).parts.size() == c.parts);
  }
  const auto solids = shared_file("data/meshes/geant4_gdml/solids.gdml");
  if (!solids) return;
  CHECK(complaint_of([&] { gdml::draft_of_gdml(read_text(*solids), "solids.gdml", {}); }).empty());
}
