#include <doctest/doctest.h>

#include <cmath>
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

// A crystal with an absorbing layer of glue nested in a lens of glass, a painted side, and a sensor with a
// window.
constexpr const char* kScene = R"(title = "to be exported"
ambient = "air"
[[part]]
name = "crystal"
box = { low = ["-2 mm", "-2 mm", "0 mm"], high = ["2 mm", "2 mm", "10 mm"] }
medium = "scintillator"
surface = "wrapped"
[[part]]
name = "bubble"
box = { low = ["-0.5 mm", "-0.5 mm", "4 mm"], high = ["0.5 mm", "0.5 mm", "5 mm"] }
medium = "dirty"
surface = "polished"
[[part]]
name = "diode"
box = { low = ["-2 mm", "-2 mm", "-1 mm"], high = ["2 mm", "2 mm", "0 mm"] }
sensor = "with_window"
[[contact]]
between = ["crystal", "diode"]
kind = "bonded"
surface = "polished"
[source]
type = "photons"
region = { part = "crystal" }
wavelength = "emission"
photons = 20000
[media.scintillator]
index = { n = { wavelength = [380, 500], wavelength_unit = "nm", value = [1.85, 1.80] } }
absorption = { length = "200 mm" }
scattering = { kind = "rayleigh", length = "300 mm" }
density = { value = "7.4 g/cm3" }
composition = { formula = "Lu2SiO5" }
yield = { value = "30 1/keV" }
decay = [{ time = "40 ns", rise = "0.1 ns", fraction = 1 }]
emission = { spectrum = { wavelength = [390, 420, 490], wavelength_unit = "nm", value = [0, 1, 0] } }
[media.dirty]
index = { n = 1.5 }
absorption = { length = "1 mm" }
scattering = { none = true }
[surfaces.wrapped]
base = "geant4_groundbackpainted"
gap = 1.0
reflectance = 0.9
unified = { sigma_alpha = "0.1 rad", lobe = 0.7, spike = 0.1, backscatter = 0.05, facets = "geant4" }
[sensors.with_window]
efficiency = { definition = "internal", value = 0.4 }
window = { index = 1.55 }
)";

void check_all(const std::string& text, const std::vector<std::string>& fragments) {
  for (const std::string& fragment : fragments) {
    CAPTURE(fragment);
    CHECK(text.find(fragment) != std::string::npos);
  }
}

SceneSpec loaded(const std::string& text, const char* name) {
  const auto file = scratch_folder(name) / "scene.toml";
  std::ofstream(file, std::ios::binary) << text;
  return SceneFile::load(file).spec(0);
}

gdml::GdmlExport exported(const SceneSpec& spec) {
  return gdml::export_gdml(scene::SceneBuilder().build(spec));
}

SceneSpec imported(const gdml::GdmlExport& file) {
  gdml::GdmlImport options;
  options.mesh_folder = "meshes";
  const auto scene = scratch_folder("gdml_back") / "scene.toml";
  write_scene_draft(gdml::draft_of_gdml(file.text, "exported.gdml", options), scene);
  return SceneFile::load(scene).spec(0);
}

double share(const SceneSpec& spec, Fate fate) {
  return simulation::Simulation(spec).run_all().points[0].fraction(fate).value;
}

}  // namespace

TEST_CASE(
    "GDML export: a scene that is exported and imported again detects and absorbs the same shares of the "
    "light") {
  const SceneSpec original = loaded(kScene, "gdml_export");
  const gdml::GdmlExport file = exported(original);
  for (const std::string& note : file.notes) MESSAGE(note);
  SceneSpec again = imported(file);
  REQUIRE(again.parts.size() == 5);  // and the surroundings, and the body inside the sensor's window
  again.source = original.source;
  again.run.seed = 12;
  for (const Fate fate : {Fate::detected, Fate::absorbed_at_surface, Fate::absorbed_in_medium}) {
    const double one = share(original, fate), other = share(again, fate);
    CAPTURE(static_cast<int>(fate));
    // Counts of 20000 photons each: 4 standard errors of the difference, a false alarm in 16000.
    const double error = std::sqrt((one * (1.0 - one) + other * (1.0 - other)) / 20000.0);
    CAPTURE(one);
    CAPTURE(other);
    CHECK(std::abs(one - other) < 4.0 * error);
    CHECK(one > 0.01);
  }
}

TEST_CASE("GDML export: compositions, densities, tables and directions of borders are in the file") {
  const gdml::GdmlExport file = exported(loaded(kScene, "gdml_export_text"));
  check_all(file.text, {"<tessellated name=\"crystal_solid\">", "name=\"RAYLEIGH\"", "Z=\"71\"",
                        "name=\"SCINTILLATIONCOMPONENT1\"", "finish=\"groundbackpainted\"",
                        "name=\"crystal_to_surroundings\"", "name=\"surroundings_to_crystal\"",
                        "finish=\"groundfrontpainted\"", "auxtype=\"SensDet\""});
  const SceneSpec again = imported(file);
  for (const PartSpec& part : again.parts)
    if (part.name.name == "bubble") CHECK(part.medium.name == "dirty");
}

TEST_CASE("GDML export: what Geant4 has no counterpart for is listed with its effect") {
  std::string text = kScene;
  text.replace(text.find("kind = \"bonded\"\nsurface = \"polished\""), 36, "kind = \"dry\"");
  text.replace(text.find("surface = \"wrapped\""), 19, "surface = \"polished\"");
  const gdml::GdmlExport dry = exported(loaded(text, "gdml_export_dry"));
  std::string notes;
  for (const std::string& note : dry.notes) notes += note + "\n";
  check_all(notes, {"the thin air gap of a dry contact", "crystal", "diode"});
}
