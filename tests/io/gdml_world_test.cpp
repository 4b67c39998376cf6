// The world of a GDML file, mothers without a volume of their own, and what Geant4 refuses or computes.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/gdml_texts.hpp"
#include "scintray/exchange/scene_draft.hpp"
#include "scintray/scene/build_scene.hpp"
#include "scintray/scene_file/read_scene.hpp"
#include "scintray/simulation/simulation_point.hpp"
#include "support/agreement.hpp"
#include "support/folders.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::exchange;
using namespace scintray::test;

namespace {

SceneDraft draft_of(const std::string& text) {
  gdml::GdmlImport options;
  options.mesh_folder = "meshes";
  return gdml::draft_of_gdml(text, "test.gdml", options);
}

tally::PointResult traced_draft(SceneDraft draft, const std::string& name, const std::string& photons) {
  const std::size_t at = draft.toml.find("photons = 10_000");
  REQUIRE(at != std::string::npos);
  draft.toml.replace(at, std::string("photons = 10_000").size(), "photons = " + photons);
  const auto file = scratch_folder("gdml_world_" + name) / "scene.toml";
  write_scene_draft(draft, file);
  scene::SceneBuilder builder;
  return simulation::SimulationPoint(scene_file::SceneFile::load(file).spec(0), builder).trace({});
}

/// A file whose world of 1 m has this material, and a cube of 2 mm of it in its middle.
std::string world_of(const std::string& properties) {
  GdmlText text = gdml_solid(R"(<box name="it" x="2" y="2" z="2"/>)");
  text.define = R"(<matrix name="N" coldim="2" values="2*eV 1.33 4*eV 1.33"/>
<matrix name="L" coldim="2" values="2*eV 500*mm 4*eV 500*mm"/>
<matrix name="FAR" coldim="2" values="2*eV 10*km 4*eV 10*km"/>
)";
  text.materials = "<material name=\"Fluid\"><property name=\"RINDEX\" ref=\"N\"/>" + properties +
                   "<D value=\"1\"/></material>\n";
  text.structure = gdml_volume("body", "it", "Fluid");
  std::string file = text.text();
  const std::string world = "<volume name=\"World\"><materialref ref=\"Vacuum\"/>";
  file.replace(file.find(world), world.size(), "<volume name=\"World\"><materialref ref=\"Fluid\"/>");
  return file;
}

std::string notes_of(const SceneDraft& draft) {
  std::string notes;
  for (const std::string& note : draft.notes) notes += note + "\n";
  return notes;
}

/// The words of the error of a file, with its hints; empty without one.
std::string error_of(const GdmlText& text) {
  try {
    draft_of(text.text());
  } catch (const InputError& error) {
    std::string words;
    for (const Problem& problem : error.problems()) words += problem.what + "\n" + problem.hint + "\n";
    return words;
  }
  return "";
}

}  // namespace

TEST_CASE("GDML: light leaves a world that absorbs at its box, as exp(-d/L) over all directions") {
  const tally::PointResult result =
      traced_draft(draft_of(world_of(R"(<property name="ABSLENGTH" ref="L"/>)")), "absorbs", "40_000");
  // Midpoint rule over the directions through one face: d = 500 mm / cosine.
  double sum = 0.0, weight = 0.0;
  constexpr int kSteps = 400;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const double x = (2.0 * i + 1.0) / kSteps - 1.0, y = (2.0 * j + 1.0) / kSteps - 1.0;
      const double length = std::sqrt(1.0 + x * x + y * y), solid_angle = std::pow(length, -3.0);
      sum += solid_angle * std::exp(-500.0 * length / 500.0);
      weight += solid_angle;
    }
  CHECK(result.lost == 0);
  const Estimate escaped = result.fraction(Fate::escaped);
  CHECK(std::abs(escaped.value - sum / weight) < kSigmas * escaped.error);
  CHECK(sum / weight > 0.2);
}

TEST_CASE("GDML: a world that is clear is the ambient medium, without a part") {
  CHECK_FALSE(contains(draft_of(world_of("")).toml, "name = \"World\""));
  CHECK_FALSE(
      contains(draft_of(world_of(R"(<property name="ABSLENGTH" ref="FAR"/>)")).toml, "name = \"World\""));
  CHECK(contains(draft_of(world_of(R"(<property name="RAYLEIGH" ref="L"/>)")).toml, "name = \"World\""));
}

TEST_CASE("GDML: a mother that its daughter fills is left out, and that is listed") {
  GdmlText text = gdml_solid(R"(<box name="it" x="2" y="2" z="2"/>)");
  text.structure =
      gdml_volume("core", "it") + gdml_volume("body", "it", "Lead", gdml_placed("core_phys", "core"));
  const SceneDraft draft = draft_of(text.text());
  CHECK_FALSE(contains(draft.toml, "name = \"body_phys\""));
  CHECK(contains(notes_of(draft), "volume body is filled by its daughter"));
  const tally::PointResult result = traced_draft(draft, "filled", "1_000");
  CHECK(result.lost == 0);
  CHECK(result.count(Fate::escaped) > 0);
}

TEST_CASE("GDML: light does not start in a mother of which its daughters leave nothing") {
  GdmlText text = gdml_solid(R"(<box name="it" x="4" y="2" z="2"/><box name="half" x="2" y="2" z="2"/>)");
  text.structure =
      gdml_volume("piece", "half") + gdml_volume("body", "it", "Glass",
                                                 gdml_placed("left", "piece", R"(<position x="-1"/>)") +
                                                     gdml_placed("right", "piece", R"(<position x="1"/>)"));
  const SceneDraft draft = draft_of(text.text());
  CHECK(contains(draft.toml, "region = { part = \"left\" }"));
  CHECK(traced_draft(draft, "tiled", "1_000").lost == 0);
}

TEST_CASE(
    "GDML: materials that are nowhere and energies that are not of light are refused with their place") {
  GdmlText text = gdml_solid(R"(<box name="it" x="2" y="2" z="2"/>)");
  text.structure = gdml_volume("body", "it", "Glas");
  check_contains(error_of(text), {"no material is called \"Glas\""});
  check_contains(error_of(text), {"the file has", "\"Glass\""});
  text.structure = gdml_volume("body", "it", "G4_Pb");
  CHECK(contains(notes_of(draft_of(text.text())), "G4_Pb is one of Geant4's own database"));
  text.structure = gdml_volume("body", "it", "Odd");
  text.define = "<matrix name=\"M\" coldim=\"2\" values=\"2 1.5 4 1.5\"/>\n";
  text.materials =
      "<material name=\"Odd\"><property name=\"RINDEX\" ref=\"M\"/><D value=\"1\"/></material>\n";
  check_contains(error_of(text), {"RINDEX of material \"Odd\"", "at 2e+06 eV"});
  check_contains(error_of(text), {"in MeV"});
  text.define = "<matrix name=\"M\" coldim=\"2\" values=\"2*eV 1.5 4*eV 0.9\"/>\n";
  check_contains(complaint_of([&] { draft_of(text.text()); }),
                 {"test.gdml:12:23: error:", "\"Odd\"", "from 0.9 to 1.5"});
  // Where no volume consists of it, it is of no account.
  text.structure = gdml_volume("body", "it");
  CHECK(error_of(text).empty());
}

TEST_CASE(
    "GDML: Rayleigh scattering without RAYLEIGH, as Geant4 computes it for water and compressible matter") {
  // Lengths that Celeritas expects of its RayleighMfpCalculator (celeritas-project/celeritas,
  // RayleighMfpCalculator.test.cc, read): 1189584.7068151 cm and 277.60444893823 cm.
  const auto imported = [](const std::string& name, const std::string& more) {
    GdmlText text = gdml_solid(R"(<box name="it" x="2" y="2" z="2"/>)");
    text.define =
        "<matrix name=\"M\" coldim=\"2\" values=\"1.098177*eV 1.3235601610672 6.812319*eV "
        "1.4679465862259\"/>\n"
        "<matrix name=\"B\" coldim=\"1\" values=\"7.658e-23*m3/MeV\"/>\n";
    text.materials = "<material name=\"" + name + "\"><property name=\"RINDEX\" ref=\"M\"/>" + more +
                     "<T unit=\"K\" value=\"283.15\"/><D value=\"1\"/></material>\n";
    text.structure = gdml_volume("body", "it", name);
    return draft_of(text.text()).toml;
  };
  check_contains(imported("Water", ""), {"kind = \"rayleigh\"", "2776.04449", "11895847.1"});
  check_contains(imported("Gas", R"(<property name="ISOTHERMAL_COMPRESSIBILITY" ref="B"/>)"),
                 {"kind = \"rayleigh\"", "2776.04449", "11895847.1"});
  CHECK_FALSE(contains(imported("Oil", ""), "rayleigh"));
}

TEST_CASE("GDML: RESOLUTIONSCALE is the width of the light beyond counting") {
  GdmlText text = gdml_solid(R"(<box name="it" x="2" y="2" z="2"/>)");
  text.define = R"(<matrix name="R" coldim="1" values="4"/><matrix name="Y" coldim="1" values="10000/MeV"/>
<matrix name="S" coldim="2" values="2*eV 1 3*eV 1"/><matrix name="T" coldim="1" values="40*ns"/>
)";
  text.materials = R"(<material name="Light"><property name="RINDEX" ref="N15"/>
<property name="SCINTILLATIONYIELD" ref="Y"/><property name="RESOLUTIONSCALE" ref="R"/>
<property name="SCINTILLATIONCOMPONENT1" ref="S"/><property name="SCINTILLATIONTIMECONSTANT1" ref="T"/>
<D value="1"/></material>
)";
  text.structure = gdml_volume("body", "it", "Light");
  const SceneDraft draft = draft_of(text.text());
  // 2.35482 sqrt((16 - 1) / 5110) = 0.127583.
  check_contains(draft.toml, {"intrinsic_resolution = {", "fwhm = 0.127583", "energy = \"511 keV\""});
  CHECK_FALSE(contains(notes_of(draft), "RESOLUTIONSCALE"));
}
