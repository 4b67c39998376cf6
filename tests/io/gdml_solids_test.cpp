// The solids of GDML as meshes.
#include <doctest/doctest.h>

#include <cmath>

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
using namespace scintray::mesh;
using namespace scintray::exchange;
using namespace scintray::test;

namespace {

/// The mesh of the solid "it".
TriMesh solid(const std::string& text, const Tessellation& tessellation = {}) {
  const gdml::GdmlFile file(gdml_solid(text).text(), "test.gdml");
  const gdml::Definitions definitions(file);
  gdml::Solids solids(file, definitions, tessellation);
  return solids.mesh("it", {});
}

/// Relative error that the default tessellation makes in the volume of a round solid of some mm.
constexpr double kRound = 0.004;

}  // namespace

TEST_CASE("GDML: every solid that is made is closed, outward, and has the volume of its formula") {
  struct Case {
    const char* text;
    double volume, tolerance;
  };
  const double flat = 1e-9;
  const Case cases[] = {
      {R"(<box name="it" lunit="cm" x="1" y="2" z="3"/>)", 6000.0, flat},
      {R"(<tube name="it" rmin="3" rmax="5" z="10" startphi="0" deltaphi="360" aunit="deg"/>)", kPi * 16 * 10,
       kRound},
      {R"(<tube name="it" rmax="5" z="10" startphi="30" deltaphi="90" aunit="deg"/>)", kPi * 25 / 4 * 10,
       kRound},
      {R"(<cone name="it" rmin1="1" rmax1="4" rmin2="2" rmax2="6" z="9" deltaphi="twopi"/>)",
       kPi * 9 / 3 * (16 + 36 + 24 - 1 - 4 - 2), kRound},
      {R"(<cone name="it" rmax1="3" rmax2="0" z="4" deltaphi="twopi"/>)", kPi * 9 * 4 / 3, kRound},
      {R"(<trd name="it" x1="10" x2="10" y1="10" y2="20" z="30"/>)", 30 * 10 * 15, flat},
      {R"(<trap name="it" z="8" theta="10" phi="20" y1="3" x1="4" x2="5" alpha1="15" y2="3" x3="4" x4="5"
          alpha2="15" aunit="deg"/>)",
       8 * 3 * 4.5, flat},
      {R"(<para name="it" x="2" y="3" z="4" alpha="10" theta="20" phi="30" aunit="deg"/>)", 24, flat},
      {R"(<arb8 name="it" dz="5" v1x="-2" v1y="-2" v2x="-2" v2y="2" v3x="2" v3y="2" v4x="2" v4y="-2"
          v5x="-1" v5y="-1" v6x="-1" v6y="1" v7x="1" v7y="1" v8x="1" v8y="-1"/>)",
       10.0 / 3.0 * (16 + 4 + 8), flat},
      {R"(<xtru name="it"><twoDimVertex x="0" y="0"/><twoDimVertex x="3" y="0"/><twoDimVertex x="0" y="4"/>
          <section zOrder="1" zPosition="5" xOffset="2" yOffset="0" scalingFactor="2"/>
          <section zOrder="0" zPosition="0" xOffset="0" yOffset="0" scalingFactor="1"/></xtru>)",
       5.0 / 3.0 * (6 + 24 + 12), flat},
      {R"(<polycone name="it" deltaphi="360" aunit="deg"><zplane z="0" rmin="1" rmax="5"/>
          <zplane z="6" rmin="1" rmax="5"/><zplane z="6" rmin="1" rmax="3"/><zplane z="9" rmin="1" rmax="3"/></polycone>)",
       kPi * (24 * 6 + 8 * 3), kRound},
      {R"(<genericPolycone name="it" deltaphi="360" aunit="deg"><rzpoint r="0" z="0"/><rzpoint r="5" z="2"/>
          <rzpoint r="0" z="4"/></genericPolycone>)",
       kPi * 25 * 4 / 3, kRound},
      // A prism over a square of side 4: the radius is that of its flats.
      {R"(<polyhedra name="it" numsides="4" deltaphi="360" aunit="deg"><zplane z="0" rmax="2"/>
          <zplane z="7" rmax="2"/></polyhedra>)",
       16 * 7, flat},
      {R"(<genericPolyhedra name="it" numsides="4" deltaphi="360" aunit="deg"><rzpoint r="0" z="0"/>
          <rzpoint r="2" z="0"/><rzpoint r="0" z="3"/></genericPolyhedra>)",
       16, flat},
      {R"(<sphere name="it" rmax="5" deltaphi="twopi" deltatheta="pi"/>)", 4.0 / 3.0 * kPi * 125, kRound},
      {R"(<sphere name="it" rmin="3" rmax="5" deltaphi="twopi" deltatheta="pi"/>)", 4.0 / 3.0 * kPi * 98,
       kRound},
      {R"(<sphere name="it" rmin="3" rmax="5" startphi="0" deltaphi="90" starttheta="0" deltatheta="90" aunit="deg"/>)",
       4.0 / 3.0 * kPi * 98 / 8, kRound},
      {R"(<orb name="it" r="2" lunit="cm"/>)", 4.0 / 3.0 * kPi * 8000, kRound},
      {R"(<torus name="it" rmax="1" rtor="5" deltaphi="twopi"/>)", 2 * kPi * kPi * 5, kRound},
      {R"(<torus name="it" rmin="0.5" rmax="1" rtor="5" deltaphi="twopi"/>)", 2 * kPi * kPi * 5 * 0.75,
       0.006},
      {R"(<torus name="it" rmax="1" rtor="5" startphi="1" deltaphi="pi"/>)", kPi * kPi * 5, kRound},
      // Hollow, and not all round: G4Torus, by Pappus' theorem.
      {R"(<torus name="it" rmin="0.5" rmax="1" rtor="5" startphi="1" deltaphi="pi"/>)", kPi * kPi * 5 * 0.75,
       0.006},
      {R"(<ellipsoid name="it" ax="2" by="3" cz="4"/>)", 4.0 / 3.0 * kPi * 24, kRound},
      {R"(<ellipsoid name="it" ax="2" by="3" cz="4" zcut1="-4" zcut2="0.000001"/>)", 2.0 / 3.0 * kPi * 24,
       kRound},
      {R"(<eltube name="it" dx="2" dy="3" dz="4"/>)", kPi * 6 * 8, kRound},
      {R"(<elcone name="it" dx="0.5" dy="0.25" zmax="10" zcut="4"/>)",
       kPi * 0.125 / 3 * (14.0 * 14 * 14 - 6.0 * 6 * 6), kRound},
      {R"(<paraboloid name="it" rlo="1" rhi="3" dz="5"/>)", kPi * 10 * 5, kRound},
      {R"(<hype name="it" rmin="1" rmax="3" inst="0" outst="0.5" z="10"/>)",
       kPi * (8 * 10 + std::pow(std::tan(0.5), 2) * 1000.0 / 12.0), kRound},
      // Planes through the middles of the ends leave the volume of a whole tube as it is.
      {R"(<cutTube name="it" rmin="3" rmax="5" z="20" deltaphi="360" aunit="deg" lowX="0.3" lowY="0.1" lowZ="-0.9"
          highX="0" highY="-0.5" highZ="0.8"/>)",
       kPi * 16 * 20, kRound},
      // Of half a tube the heights are 20 + c rho sin(phi), c = 0.5 / 0.8, rho from 3 to 5, phi from 0 to pi.
      {R"(<cutTube name="it" rmin="3" rmax="5" z="20" deltaphi="180" aunit="deg" lowX="0" lowY="0" lowZ="-1"
          highX="0" highY="-0.5" highZ="0.8"/>)",
       kPi * 8 * 20 + 0.625 * 2 * (125 - 27) / 3, kRound},
      // Twisted bodies have the areas of their untwisted cross-sections (G4VTwistedFaceted::GetCubicVolume).
      {R"(<twistedbox name="it" PhiTwist="1" x="3" y="4" z="5"/>)", 60, 0.003},
      {R"(<twistedtrd name="it" PhiTwist="-40" aunit="deg" x1="4" x2="2" y1="6" y2="3" z="10"/>)",
       ((4 + 2) * (6 + 3) + (2 - 4) * (3 - 6) / 3.0) * 10 / 4.0, 0.003},
      {R"(<twistedtrap name="it" PhiTwist="30" aunit="deg" z="10" Theta="10" Phi="20" y1="6" x1="4" x2="5" y2="3"
          x3="2" x4="2.5" Alph="15"/>)",
       ((2 + 2.5 + 1 + 1.25) * (3 + 1.5) + (1.25 + 1 - 2.5 - 2) * (1.5 - 3) / 3.0) * 5, 0.003},
      // Between two hyperboloids: G4TwistedTubs::GetCubicVolume, with the radii of the ends and of the
      // middle.
      {R"(<twistedtubs name="it" twistedangle="1" endinnerrad="4" endouterrad="6" zlen="10" phi="0.8"/>)",
       0.8 / 6.0 * 10 * (2 * 20 * std::pow(std::cos(0.5), 2) + 20), 0.004},
      {R"(<twistedtubs name="it" twistedangle="-60" aunit="deg" midinnerrad="4" midouterrad="6" negativeEndz="-3"
          positiveEndz="6" nseg="6" totphi="360"/>)",
       kPi / 3 / 6.0 * (2 * 9 * 20 + 20.0 * (6 * (1 + 1.0 / 3) + 3 * (1 + 1.0 / 12))), 0.004},
      {R"(<box name="b" x="2" y="2" z="2"/><orb name="o" r="1"/><multiUnion name="it">
          <multiUnionNode name="n1"><solid ref="b"/></multiUnionNode>
          <multiUnionNode name="n2"><solid ref="b"/><position x="1" y="1"/></multiUnionNode>
          <multiUnionNode name="n3"><solid ref="b"/><position x="10"/><rotation z="45" unit="deg"/></multiUnionNode>
          </multiUnion>)",
       8 + 8 - 2 + 8, flat},
      {R"(<trd name="t" x1="2" x2="4" y1="2" y2="2" z="3"/>
          <reflectedSolid name="it" solid="t" sx="1" sy="1" sz="-1" rx="90" ry="0" rz="0" dx="1" dy="2" dz="3"
          aunit="deg"/>)",
       18, flat},
      {R"(<orb name="o" r="2"/><scaledSolid name="it"><solidref ref="o"/><scale x="1" y="2" z="3"/></scaledSolid>)",
       4.0 / 3.0 * kPi * 8 * 6, kRound},
  };
  for (const Case& c : cases) {
    CAPTURE(c.text);
    const MeshDiagnosis diagnosis = diagnose(solid(c.text));
    CHECK(diagnosis.sound());
    CHECK(diagnosis.volume_mm3 == doctest::Approx(c.volume).epsilon(c.tolerance));
  }
}

TEST_CASE("GDML: booleans turn and move their solids as Geant4 does") {
  const std::string boxes = R"(<box name="a" x="4" y="4" z="4"/><box name="b" x="2" y="2" z="10"/>)";
  const auto volume = [&](const std::string& boolean) { return solid(boxes + boolean).volume(); };
  CHECK(volume(R"(<subtraction name="it"><first ref="a"/><second ref="b"/></subtraction>)") ==
        doctest::Approx(48.0));
  CHECK(volume(R"(<intersection name="it"><first ref="a"/><second ref="b"/></intersection>)") ==
        doctest::Approx(16.0));
  CHECK(volume(R"(<union name="it"><first ref="a"/><second ref="b"/></union>)") == doctest::Approx(88.0));
  CHECK(volume(R"(<union name="it"><first ref="a"/><second ref="a"/><position x="2"/></union>)") ==
        doctest::Approx(96.0));
  // Turned by +90 deg about z, a box beside the axis goes from +x to +y: the rotation is taken as it is.
  const TriMesh turned = solid(
      R"(<box name="a" x="4" y="4" z="4"/><box name="c" x="6" y="1" z="1"/><box name="m" x="1" y="1" z="1"/>
<union name="arm"><first ref="c"/><second ref="m"/><position x="3.4"/></union>
<union name="it"><first ref="a"/><second ref="arm"/><rotation z="90" unit="deg"/></union>)");
  CHECK(diagnose(turned).bounds.max().y() == doctest::Approx(3.9));
  CHECK(diagnose(turned).bounds.min().y() == doctest::Approx(-3.0));
  // A boolean of a boolean, with the first solid moved.
  CHECK(volume(R"(<union name="u"><first ref="a"/><second ref="b"/></union>
<subtraction name="it"><first ref="u"/><second ref="a"/><firstposition z="1"/></subtraction>)") ==
        doctest::Approx(88.0 - 64.0 + 12.0));
}

TEST_CASE("GDML: twisted and cut solids lie as Geant4 places them") {
  const auto bounds = [](const TriMesh& mesh) { return diagnose(mesh).bounds; };
  // Its upper end is turned by half the twist: the corner (1.5, 2) of the box at 30 degrees.
  const TriMesh box = solid(R"(<twistedbox name="it" PhiTwist="60" aunit="deg" x="3" y="4" z="5"/>)");
  double highest = -9.0;
  for (const Vec3& v : box.vertices)
    if (v.z() > 2.4999) highest = std::max(highest, v.y());
  CHECK(highest == doctest::Approx(1.5 * std::sin(kPi / 6) + 2 * std::cos(kPi / 6)));
  // G4CutTubs: the plane through (0, 0, 10) with the normal (0, -0.5, 0.8) is at z = 10 + 0.625 y.
  const TriMesh cut = solid(
      R"(<cutTube name="it" rmax="4" z="20" deltaphi="360" aunit="deg" lowX="0" lowY="0" lowZ="-1" highX="0"
highY="-0.5" highZ="0.8"/>)");
  CHECK(bounds(cut).max().z() == doctest::Approx(10 + 0.625 * 4));
  CHECK(bounds(cut).min().z() == doctest::Approx(-10));
  // Turned by +90 deg about x after the reflection of z: (x, y, z) goes to (x, z, y), then moves.
  const TriMesh reflected = solid(R"(<trd name="t" x1="2" x2="4" y1="2" y2="2" z="3"/>
<reflectedSolid name="it" solid="t" sx="1" sy="1" sz="-1" rx="90" ry="0" rz="0" dx="1" dy="2" dz="3" aunit="deg"/>)");
  for (const Vec3& v : reflected.vertices) CHECK(std::abs(v.x() - 1) == doctest::Approx(v.y() > 2 ? 2 : 1));
  CHECK(bounds(reflected).min().z() == doctest::Approx(2));
}

TEST_CASE("GDML: the deviation of round solids of metres is a share of their radius, unless one is stated") {
  const Tessellation imported = gdml::GdmlImport().tessellation;
  const auto tube = [](const std::string& radius_mm, const Tessellation& tessellation) {
    return solid(R"(<tube name="it" rmax=")" + radius_mm + R"(" z="10" deltaphi="360" aunit="deg"/>)",
                 tessellation);
  };
  const auto area = [](double radius_mm, int sides) {
    return 0.5 * sides * radius_mm * radius_mm * std::sin(kTwoPi / sides);
  };
  // 1e-4 of the radius is kept by 223 sides or more: 288, the third of 72, 144, 288, at any size. At 0.01 mm
  // a tube of 20 m has 4608.
  for (const double radius_mm : {200.0, 2e3, 2e4})
    CHECK(diagnose(tube(std::to_string(radius_mm), imported)).volume_mm3 ==
          doctest::Approx(10.0 * area(radius_mm, 288)).epsilon(1e-9));
  CHECK(diagnose(tube("20000", {})).volume_mm3 == doctest::Approx(10.0 * area(2e4, 4608)).epsilon(1e-9));
  CHECK(tube("20", imported).triangles.size() == tube("20", {}).triangles.size());
  const TriMesh vessel = solid(R"(<orb name="it" r="5000"/>)", imported);
  CHECK(vessel.triangles.size() < 100000);
  CHECK(diagnose(vessel).volume_mm3 == doctest::Approx(kPi / 0.75 * 1.25e11).epsilon(4e-4));
}

TEST_CASE("GDML: round solids are known as round, prisms of many sides are not") {
  const auto is_round = [](const std::string& text) {
    const gdml::GdmlFile file(gdml_solid(text).text(), "test.gdml");
    const gdml::Definitions definitions(file);
    gdml::Solids solids(file, definitions, {});
    return solids.is_round("it", {});
  };
  CHECK(is_round(R"(<tube name="it" rmax="5" z="10" deltaphi="360" aunit="deg"/>)"));
  CHECK(is_round(R"(<orb name="it" r="5"/>)"));
  CHECK(is_round(R"(<cone name="it" rmax1="3" rmax2="0" z="4" deltaphi="twopi"/>)"));
  CHECK_FALSE(is_round(R"(<box name="it" lunit="cm" x="1" y="2" z="3"/>)"));
  CHECK_FALSE(is_round(R"(<ellipsoid name="it" ax="1" by="2" cz="3"/>)"));
  const std::string prism =
      R"(numsides="24" deltaphi="360" aunit="deg"><zplane z="0" rmin="0" rmax="5"/><zplane z="6" rmin="0" rmax="5"/></polyhedra>)";
  CHECK_FALSE(is_round(R"(<polyhedra name="it" )" + prism));
  CHECK_FALSE(is_round(R"(<polyhedra name="p" )" + prism +
                       R"(<tube name="t" rmax="2" z="4" deltaphi="360" aunit="deg"/><union name="it">)"
                       R"(<first ref="p"/><second ref="t"/><position z="6"/></union>)"));
}

TEST_CASE("GDML: tori, ellipsoids of revolution, paraboloids and hyperboloids keep their exact surface") {
  struct Case {
    const char* text;
    double volume;
  };
  // Of z from u to v an ellipsoid of the half axes a and c has pi a^2 (v - u - (v^3 - u^3) / (3 c^2)).
  const double wide = std::pow(std::tan(0.5), 2), narrow = std::pow(std::tan(0.1), 2);
  const Case cases[] = {
      {R"(<torus name="it" rmax="1" rtor="5" deltaphi="twopi"/>)", 2 * kPi * kPi * 5},
      {R"(<ellipsoid name="it" ax="2" by="2" cz="4"/>)", 4.0 / 3.0 * kPi * 16},
      {R"(<ellipsoid name="it" ax="3" by="3" cz="2" zcut1="-1" zcut2="1.5"/>)",
       kPi * 9 * (2.5 - (3.375 + 1.0) / 12.0)},
      {R"(<paraboloid name="it" rlo="1" rhi="3" dz="5"/>)", kPi * 10 * 5},
      {R"(<paraboloid name="it" rhi="3" dz="5"/>)", kPi * 9 * 5},
      {R"(<hype name="it" rmin="1" rmax="3" inst="0" outst="0.5" z="10"/>)",
       kPi * (8 * 10 + wide * 1000.0 / 12)},
      {R"(<hype name="it" rmin="1" rmax="3" inst="0.1" outst="0.5" z="10"/>)",
       kPi * (8 * 10 + (wide - narrow) * 1000.0 / 12)},
      {R"(<hype name="it" rmax="3" outst="0.5" z="10"/>)", kPi * (9 * 10 + wide * 1000.0 / 12)},
  };
  for (const Case& c : cases) {
    CAPTURE(c.text);
    gdml::GdmlImport options;
    options.mesh_folder = "meshes";
    const auto file = scratch_folder("gdml_exact") / "scene.toml";
    const SceneDraft draft = gdml::draft_of_gdml(gdml_solid(c.text).text(), "test.gdml", options);
    CHECK(draft.meshes.empty());
    write_scene_draft(draft, file);
    const scene::BuiltScene built = scene::SceneBuilder().build(scene_file::SceneFile::load(file).spec(0));
    CHECK(built.scene.parts.front().facets_because == "");
    CHECK(built.scene.parts.front().curved);
    CHECK(built.scene.parts.front().volume_mm3 == doctest::Approx(c.volume).epsilon(1e-9));
  }
}

TEST_CASE("GDML: hollow tori and sectors of tori are exact, recognized in their meshes") {
  // Sectors of less than a segment of others, of half a turn, whose ends are in one plane, and of more than
  // half a turn, where the planes of the ends cross the rest.
  for (const double extent : {0.08, 1.0, kPi, 5.0, kTwoPi})
    for (const double inner : {0.0, 0.05, 0.6, 0.98}) {
      if (extent == kTwoPi && inner == 0.0) continue;  // a shape of the scene file
      CAPTURE(extent);
      CAPTURE(inner);
      gdml::GdmlImport options;
      options.mesh_folder = "meshes";
      const auto file = scratch_folder("gdml_tori") / "scene.toml";
      const std::string text =
          fmt::format(R"(<torus name="it" rmin="{}" rmax="1" rtor="5" startphi="0.4" deltaphi="{:.17g}"/>)",
                      inner, extent);
      const SceneDraft draft = gdml::draft_of_gdml(gdml_solid(text).text(), "test.gdml", options);
      CHECK(draft.toml.find("curved = \"recognize\"") != std::string::npos);
      write_scene_draft(draft, file);
      const scene::BuiltScene built = scene::SceneBuilder().build(scene_file::SceneFile::load(file).spec(0));
      CHECK(built.scene.parts.front().facets_because == "");
      CHECK(built.scene.parts.front().curved);
      // Pappus: the length of the circle in the middle times the section's area, and its outline.
      const double length = 5.0 * extent, ends = extent < kTwoPi ? 2.0 : 0.0;
      const double section = kPi * (1.0 - inner * inner);
      CHECK(built.scene.parts.front().volume_mm3 == doctest::Approx(length * section).epsilon(1e-7));
      double area = 0.0;
      for (const scene::FaceInfo& face : built.scene.faces) area += face.area_mm2;
      CHECK(area == doctest::Approx(length * kTwoPi * (1.0 + inner) + ends * section).epsilon(1e-6));
    }
}
