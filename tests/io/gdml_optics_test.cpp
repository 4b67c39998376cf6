#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <optional>

#include "io/gdml_texts.hpp"
#include "scintray/exchange/scene_draft.hpp"
#include "scintray/scene/build_scene.hpp"
#include "scintray/scene_file/read_scene.hpp"
#include "scintray/simulation/simulation_point.hpp"
#include "support/agreement.hpp"
#include "support/evidence.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene_file;
using namespace scintray::exchange;
using namespace scintray::test;

namespace {

/// The scene of a GDML text; `source` replaces the example source.
SceneSpec scene_of(const GdmlText& text, const std::string& source = "") {
  static int number = 0;
  gdml::GdmlImport options;
  options.mesh_folder = "meshes";
  SceneDraft draft = gdml::draft_of_gdml(text.text(), "test.gdml", options);
  if (!source.empty()) {
    const std::size_t from = draft.toml.find("[source]"), to = draft.toml.find("\n\n[", from);
    draft.toml.replace(from, to - from, "[source]\ntype = \"photons\"\n" + source);
  }
  const auto file = scratch_folder("gdml_optics_" + std::to_string(++number)) / "scene.toml";
  write_scene_draft(draft, file);
  return SceneFile::load(file).spec(0);
}

std::string draft_text(const GdmlText& text) {
  return gdml::draft_of_gdml(text.text(), "test.gdml", {}).toml;
}

tally::PointResult traced_gdml(const GdmlText& text, const std::string& source) {
  scene::SceneBuilder builder;
  const simulation::SimulationPoint point(scene_of(text, source), builder);
  const tally::PointResult result = point.trace({});
  CHECK(result.lost == 0);
  return result;
}

optics::Medium medium_of(const SceneSpec& spec, const std::string& name) {
  materials::MaterialDatabase database = materials::MaterialDatabase::shipped();
  scene::add_definitions(database, spec);
  return database.medium(name, {});
}

constexpr const char* kTables = R"(<matrix name="FULL" coldim="2" values="2*eV 1 4*eV 1"/>
<matrix name="NONE" coldim="2" values="2*eV 0 4*eV 0"/><matrix name="R40" coldim="2" values="2*eV 0.4 4*eV 0.4"/>
<matrix name="T25" coldim="2" values="2*eV 0.25 4*eV 0.25"/><matrix name="E30" coldim="2" values="2*eV 0.3 4*eV 0.3"/>
<matrix name="N1" coldim="2" values="2*eV 1 4*eV 1"/>
)";

/// A beam along z from a block into the plate "target" that touches it, both of the index of the world.
GdmlText plate(const std::string& surface, const std::string& placed_surface,
               const std::string& material = "Plate", const std::string& auxiliary = "") {
  GdmlText text;
  text.define = kTables;
  text.materials = R"(<material name="Block"><property name="RINDEX" ref="N1"/></material>
<material name="Plate"><property name="RINDEX" ref="N1"/></material>)";
  text.solids = R"(<box name="cube" x="10" y="10" z="10"/>)" + surface;
  text.structure = gdml_volume("source_v", "cube", "Block") +
                   gdml_volume("target_v", "cube", material, auxiliary) + placed_surface;
  text.daughters =
      gdml_placed("source", "source_v") + gdml_placed("target", "target_v", R"(<position z="10"/>)");
  return text;
}

constexpr const char* kBeam =
    "position = [\"0 mm\", \"0 mm\", \"0 mm\"]\ndirection = [0, 0, 1]\nwavelength = \"420 nm\"\nphotons = "
    "40_000\n";
constexpr const char* kSkin =
    R"(<skinsurface name="s" surfaceproperty="it"><volumeref ref="target_v"/></skinsurface>)";
constexpr const char* kSensitive = R"(<auxiliary auxtype="SensDet" auxvalue="SD"/>)";

std::string optical_surface(const std::string& type, const std::string& properties,
                            const std::string& finish = "polished") {
  return "<opticalsurface name=\"it\" model=\"unified\" finish=\"" + finish + "\" type=\"" + type +
         "\" value=\"0\">" + properties + "</opticalsurface>";
}

constexpr const char* kR40 = R"(<property name="REFLECTIVITY" ref="R40"/>)";
constexpr const char* kT25 = R"(<property name="TRANSMITTANCE" ref="T25"/>)";
constexpr const char* kE30 = R"(<property name="EFFICIENCY" ref="E30"/>)";

void check_near(const tally::PointResult& result, Fate fate, double law) {
  const Estimate share = result.fraction(fate);
  CAPTURE(fate_name(fate));
  CAPTURE(share.value);
  CAPTURE(law);
  const double error = std::max(share.error, 1.0 / static_cast<double>(result.photons));
  CHECK(std::abs(share.value - law) < kSigmas * error);
}

}  // namespace

TEST_CASE("GDML: a skin detects the share EFFICIENCY of what it absorbs, of metals and dielectrics alike") {
  for (const std::string type : {"dielectric_metal", "dielectric_dielectric"}) {
    CAPTURE(type);
    const tally::PointResult result =
        traced_gdml(plate(optical_surface(type, std::string(kR40) + kT25 + kE30), kSkin), kBeam);
    // At each face 0.35 are absorbed. A dielectric lets the rest through, into media of one index; a metal
    // passes 0.25 and reflects 0.4, within the plate until it is absorbed or has left.
    const double absorbed =
        type == "dielectric_metal" ? 0.35 + 0.25 * 0.35 / (1.0 - 0.4) : 0.35 * (1.0 + 0.65);
    check_near(result, Fate::detected, absorbed * 0.3);
    check_near(result, Fate::not_detected, absorbed * 0.7);
    check_near(result, Fate::escaped, 1.0 - absorbed);
    CHECK(result.count(Fate::absorbed_at_surface) == 0);
  }
}

TEST_CASE("GDML: shares beyond 1 count as Geant4 draws them: TRANSMITTANCE takes what REFLECTIVITY leaves") {
  const auto escaped = [](const std::string& reflectivity, const std::string& transmittance) {
    GdmlText text = plate(optical_surface("dielectric_metal", R"(<property name="REFLECTIVITY" ref="RR"/>
<property name="TRANSMITTANCE" ref="TT"/>)"),
                          kSkin);
    text.define += "<matrix name=\"RR\" coldim=\"2\" values=\"" + reflectivity +
                   "\"/><matrix name=\"TT\" coldim=\"2\" values=\"" + transmittance + "\"/>";
    return traced_gdml(text, kBeam).count(Fate::absorbed_at_surface);
  };
  CHECK(escaped("2*eV 1.4 4*eV 1.4", "2*eV 0.5 4*eV 0.5") == 0);
  CHECK(escaped("2*eV 0.7 3*eV 0.6 4*eV 0.7", "2*eV 0.9 4*eV 0.9") == 0);
  CHECK(escaped("2*eV -1 4*eV -1", "2*eV 0 4*eV 0") == 40'000);
}

TEST_CASE("GDML: in a sensitive volume light that enters is a hit; elsewhere only what a surface absorbs") {
  const std::string surface = optical_surface("dielectric_dielectric", std::string(kR40) + kE30);
  const tally::PointResult sensitive = traced_gdml(plate(surface, kSkin, "Plate", kSensitive), kBeam);
  check_near(sensitive, Fate::detected, 0.3);  // 0.6 are absorbed, 0.4 enter
  const tally::PointResult plain = traced_gdml(plate(surface, kSkin), kBeam);
  check_near(plain, Fate::detected, 0.3 * (0.6 + 0.4 * 0.6));  // at the front and at the back face
}

TEST_CASE("GDML: finishes of dielectrics have no effect between volumes of one material, as in Geant4") {
  const std::string surface =
      optical_surface("dielectric_dielectric", R"(<property name="REFLECTIVITY" ref="NONE"/>)");
  CHECK(traced_gdml(plate(surface, kSkin, "Block"), kBeam).count(Fate::absorbed_at_surface) ==
        40'000);  // at the far face, to the world
  const auto at = [&](const std::string& material) { return draft_text(plate(surface, kSkin, material)); };
  check_contains(at("Block"), "between_media_only = true");
  const scene::BuiltScene one = scene::SceneBuilder().build(scene_of(plate(surface, kSkin, "Block")));
  const scene::BuiltScene two = scene::SceneBuilder().build(scene_of(plate(surface, kSkin, "Plate")));
  const auto plain = [](const scene::BuiltScene& built) {
    std::size_t count = 0;
    for (const scene::Interface& i : built.scene.interfaces)
      count += i.plain && i.back != scene::kAmbientRegion && i.front != scene::kAmbientRegion;
    return count;
  };
  CHECK(plain(one) == 1);
  CHECK(plain(two) == 0);
}

TEST_CASE("GDML: a border holds for light of its direction only, and precedes skins") {
  const std::string surface = optical_surface(
      "dielectric_metal",
      R"(<property name="REFLECTIVITY" ref="NONE"/><property name="EFFICIENCY" ref="FULL"/>)");
  const auto border = [](const std::string& from, const std::string& to) {
    return "<bordersurface name=\"b\" surfaceproperty=\"it\"><physvolref ref=\"" + from +
           "\"/><physvolref ref=\"" + to + "\"/></bordersurface>";
  };
  CHECK(traced_gdml(plate(surface, border("source", "target")), kBeam).count(Fate::detected) == 40'000);
  CHECK(traced_gdml(plate(surface, border("target", "source")), kBeam).count(Fate::detected) == 0);
  // Both ends of the plate in one copy: the skin's reflectance of 1 is not seen by the border's light.
  const std::string mirror =
      optical_surface("dielectric_metal", R"(<property name="REFLECTIVITY" ref="FULL"/>)");
  std::string other = mirror;
  other.replace(other.find("\"it\""), 4, "\"other\"");
  const std::string skin =
      R"(<skinsurface name="s" surfaceproperty="other"><volumeref ref="target_v"/></skinsurface>)";
  CHECK(traced_gdml(plate(surface + other, border("source", "target") + skin), kBeam).count(Fate::detected) ==
        40'000);
  const tally::PointResult reflected =
      traced_gdml(plate(surface + other, border("target", "source") + skin), kBeam);
  CHECK(reflected.count(Fate::detected) == 0);
  CHECK(reflected.count(Fate::escaped) == 40'000);  // back, through the block's other face
}

TEST_CASE("GDML: skins of touching volumes each hold for the light that leaves their volume") {
  // The block absorbs what leaves it, the plate reflects what leaves it.
  const std::string absorbing =
      optical_surface("dielectric_metal", R"(<property name="REFLECTIVITY" ref="NONE"/>)");
  std::string mirror = optical_surface("dielectric_metal", R"(<property name="REFLECTIVITY" ref="FULL"/>)");
  mirror.replace(mirror.find("\"it\""), 4, "\"other\"");
  const std::string skins =
      R"(<skinsurface name="s" surfaceproperty="it"><volumeref ref="source_v"/></skinsurface>
<skinsurface name="t" surfaceproperty="other"><volumeref ref="target_v"/></skinsurface>)";
  const GdmlText text = plate(absorbing + mirror, skins);
  CHECK(traced_gdml(text, kBeam).count(Fate::absorbed_at_surface) == 40'000);
  std::string back = kBeam;
  back.replace(back.find("\"0 mm\"]"), 7, "\"10 mm\"]");
  back.replace(back.find("[0, 0, 1]"), 9, "[0, 0, -1]");
  const tally::PointResult trapped = traced_gdml(text, back + "[run]\nmax_interactions = 100\n");
  CHECK(trapped.count(Fate::cut_interactions) == 40'000);
}

TEST_CASE("GDML: wavelength shifters, particles and group velocities become parts of the medium") {
  GdmlText text = gdml_solid(R"(<box name="it" x="10" y="2" z="2"/>)");
  text.define = R"(<matrix name="WABS" coldim="2" values="2*eV 10*m 3*eV 2*mm 4*eV 1*mm"/>
<matrix name="WEM" coldim="2" values="3*eV 1 2*eV 1 2.5*eV 1"/><matrix name="WT" coldim="1" values="1.5*ns"/>
<matrix name="WN" coldim="1" values="0.8"/><matrix name="MIE" coldim="2" values="2*eV 7*mm 4*eV 7*mm"/>
<matrix name="GF" coldim="1" values="0.9"/><matrix name="GB" coldim="1" values="0.2"/>
<matrix name="GR" coldim="1" values="0.7"/><matrix name="VG" coldim="2" values="2*eV 190 4*eV 150"/>)";
  const auto material = [](const std::string& index_and_velocity) {
    return R"(<material name="Dye">)" + index_and_velocity + R"(<property name="WLSABSLENGTH" ref="WABS"/>
<property name="WLSCOMPONENT" ref="WEM"/><property name="WLSTIMECONSTANT" ref="WT"/>
<property name="WLSMEANNUMBERPHOTONS" ref="WN"/><property name="MIEHG" ref="MIE"/>
<property name="MIEHG_FORWARD" ref="GF"/><property name="MIEHG_BACKWARD" ref="GB"/>
<property name="MIEHG_FORWARD_RATIO" ref="GR"/></material>)";
  };
  const std::string index = R"(<property name="RINDEX" ref="N15"/>)",
                    velocity = R"(<property name="GROUPVEL" ref="VG"/>)";
  text.materials = material(index + velocity);
  text.structure = gdml_volume("body", "it", "Dye");
  const SceneSpec spec = scene_of(text);
  const optics::Medium medium = medium_of(spec, "Dye");
  REQUIRE(medium.shifter);
  const double nm = 1239.841984 / 3.0;
  CHECK(1.0 / medium.shifter->absorption_per_mm()(nm) ==
        doctest::Approx(2.0).epsilon(1e-4));  // it rises by 10 m per eV below
  const optics::Fluorophore& dye = medium.shifter->fluorophores().front();
  CHECK(dye.quantum_yield(nm) == doctest::Approx(0.8));
  CHECK(dye.statistics == optics::ShiftStatistics::poisson);  // as Geant4 with WLSMEANNUMBERPHOTONS
  CHECK(dye.rule == optics::ShiftRule::no_gain);
  CHECK(dye.decay.front().profile == optics::TimeProfile::delta);
  CHECK(dye.emission(1239.841984 / 3.0) / dye.emission(1239.841984 / 2.0) ==
        doctest::Approx(9.0 / 4.0));  // flat per energy, its rows in any order
  REQUIRE(medium.particles);
  CHECK(medium.particles->per_mm(nm) == doctest::Approx(1.0 / 7.0));
  CHECK(medium.particles->forward_g == doctest::Approx(0.9));
  CHECK(medium.particles->backward_g == doctest::Approx(0.2));
  CHECK(medium.particles->forward_share == doctest::Approx(0.7));
  CHECK(medium.at(1239.841984 / 2.0).group_index == doctest::Approx(299.792458 / 190.0));
  CHECK_NOTHROW(scene::SceneBuilder().build(spec));
  check_contains(draft_text(text), "WLSTIMECONSTANT: every photon is delayed by it");
  // Geant4 computes a group velocity when RINDEX comes after GROUPVEL.
  text.materials = material(velocity + index);
  CHECK_FALSE(medium_of(scene_of(text), "Dye").group_index);
  check_contains(draft_text(text), "its GROUPVEL, which comes before RINDEX");
}

TEST_CASE("GDML: a WLSABSLENGTH without a spectrum absorbs, beside ABSLENGTH") {
  GdmlText text = gdml_solid(R"(<box name="it" x="10" y="2" z="2"/>)");
  text.define = R"(<matrix name="L" coldim="2" values="2*eV 30*mm 4*eV 30*mm"/>)";
  text.materials = R"(<material name="Dark"><property name="RINDEX" ref="N15"/>
<property name="ABSLENGTH" ref="L"/><property name="WLSABSLENGTH" ref="L"/></material>)";
  text.structure = gdml_volume("body", "it", "Dark");
  const optics::Medium medium = medium_of(scene_of(text), "Dark");
  CHECK_FALSE(medium.shifter);
  CHECK(medium.absorption_per_mm(400.0) == doctest::Approx(2.0 / 30.0));
  check_contains(draft_text(text), "no WLSCOMPONENT");
}

TEST_CASE("GDML: matrices and names that Geant4 accepts are accepted, and what it passes over is listed") {
  GdmlText text = gdml_solid(R"(<box name="it" x="10" y="2" z="2"/>)");
  text.define =
      R"(<matrix name="ROW" coldim="3" values="4 5 6"/><matrix name="SQUARE" coldim="2" values="1 2 3 4"/>
<constant name="c" value="ROW_1 + SQUARE_1_0"/><matrix name="SLOW" coldim="1" value="43"/>)";
  text.solids = R"(<box name="it" x="c" y="2" z="2"/>)";
  text.materials = R"(<material name="Glass"><property name="RINDEX" ref="ONE"/></material>
<material name="Odd"><property name="RINDEX" ref="N15"/><property name="YIELDRATIO" value="0.8"/></material>)";
  text.structure =
      gdml_volume("body", "it") + gdml_volume("body", "it", "Lead") + gdml_volume("odd", "it", "Odd");
  text.daughters += gdml_placed("odd", "odd", R"(<position y="9"/>)");
  const std::string toml = draft_text(text);
  check_contains(toml, {"matrix SLOW has no \"values\" (it has \"value\")", "reads it as the number 0"});
  check_contains(toml, "material Glass: a second material of this name: the first is used");
  check_contains(toml, "a second volume \"body\": the first is used");
  check_contains(toml, {"without \"ref\", which Geant4 passes over", "YIELDRATIO"});
  const SceneSpec spec = scene_of(text);
  CHECK(spec.parts[0].medium.name == "Glass");
  CHECK(medium_of(spec, "Glass").index(500.0) > 1.3);  // the first of the two
  text.define = R"(<matrix name="M" coldim="2" value="1 2"/>)";
  check_contains(complaint_of([&] { draft_text(text); }), {"<matrix>", "values"});
}

TEST_CASE("GDML: coated faces, metals with an index and GLISUR have their own models") {
  GdmlText text;
  text.define = std::string(kTables) + R"(<matrix name="CI" coldim="2" values="2*eV 1.7 4*eV 1.7"/>
<matrix name="CT" coldim="1" values="100*nm"/><matrix name="ON" coldim="1" values="1"/>
<matrix name="MN" coldim="2" values="2*eV 1.38 4*eV 0.28"/><matrix name="MK" coldim="2" values="2*eV 7.31 4*eV 3.71"/>)";
  text.solids = R"(<box name="it" x="10" y="10" z="10"/>
<opticalsurface name="film" model="unified" finish="polished" type="coated" value="0">
<property name="COATEDRINDEX" ref="CI"/><property name="COATEDTHICKNESS" ref="CT"/>
<property name="COATEDFRUSTRATEDTRANSMISSION" ref="ON"/></opticalsurface>
<opticalsurface name="rough_film" model="unified" finish="ground" type="coated" value="0.2">
<property name="COATEDRINDEX" ref="CI"/><property name="COATEDTHICKNESS" ref="CT"/></opticalsurface>
<opticalsurface name="smeared_film" model="glisur" finish="ground" type="coated" value="0.7">
<property name="COATEDRINDEX" ref="CI"/><property name="COATEDTHICKNESS" ref="CT"/></opticalsurface>
<opticalsurface name="metal" model="unified" finish="polished" type="dielectric_metal" value="0">
<property name="REALRINDEX" ref="MN"/><property name="IMAGINARYRINDEX" ref="MK"/></opticalsurface>
<opticalsurface name="smeared" model="glisur" finish="ground" type="dielectric_dielectric" value="0.2"/>
<opticalsurface name="smeared_metal" model="glisur" finish="ground" type="dielectric_metal" value="0.2">
<property name="REFLECTIVITY" ref="R40"/></opticalsurface>)";
  const char* names[] = {"film", "metal", "smeared", "smeared_metal", "rough_film", "smeared_film"};
  for (int i = 0; i < 6; ++i) {
    const std::string v = "v" + std::to_string(i);
    text.structure += gdml_volume(v, "it") + "<skinsurface name=\"s" + std::to_string(i) +
                      "\" surfaceproperty=\"" + names[i] + "\"><volumeref ref=\"" + v + "\"/></skinsurface>";
    text.daughters +=
        gdml_placed("p" + std::to_string(i), v, "<position z=\"" + std::to_string(20 * i) + "\"/>");
  }
  const SceneSpec spec = scene_of(text);
  CHECK(spec.surfaces.at("film")->find("model")->text == "thin_film");
  CHECK(spec.surfaces.at("metal")->find("model")->text == "metal");
  CHECK(spec.surfaces.at("smeared")->find("model")->text == "glisur");
  CHECK(spec.surfaces.at("smeared_metal")->find("model")->text == "metal");
  CHECK(spec.surfaces.at("rough_film")->find("model")->text == "thin_film");
  CHECK(spec.surfaces.at("rough_film")->find("thin_film")->find("sigma_alpha"));
  CHECK(spec.surfaces.at("smeared_film")->find("thin_film")->find("polish"));
  CHECK(draft_text(text).find("has no counterpart here") == std::string::npos);
  CHECK_NOTHROW(scene::SceneBuilder().build(spec));
}

TEST_CASE("GDML: a metal with EFFICIENCY alone is a sensor, and the difference to Geant4 is stated") {
  const GdmlText text = plate(optical_surface("0", R"(<property name="EFFICIENCY" ref="E30"/>)", "0"), kSkin);
  check_near(traced_gdml(text, kBeam), Fate::detected, 0.3);
  check_contains(draft_text(text), {"reflects nothing", "Geant4 takes REFLECTIVITY as 1"});
}

namespace {

/// A file of the shared folder as a scene; `edit` changes its text.
std::optional<SceneSpec> shared_gdml(const std::string& name,
                                     const std::function<void(std::string&)>& edit = {}) {
  const auto path = shared_file("data/gdml/" + name);
  if (!path) return std::nullopt;
  std::ifstream stream(*path, std::ios::binary);
  gdml::GdmlImport options;
  options.mesh_folder = "meshes";
  SceneDraft draft =
      gdml::draft_of_gdml({std::istreambuf_iterator<char>(stream), {}}, path->string(), options);
  CHECK(draft.missing.empty());
  if (edit) edit(draft.toml);
  const auto file = scratch_folder("gdml_shared_" + name) / "scene.toml";
  write_scene_draft(draft, file);
  return SceneFile::load(file).spec(0);
}

tally::PointResult traced_spec(SceneSpec spec) {
  scene::SceneBuilder builder;
  return simulation::SimulationPoint(std::move(spec), builder).trace({});
}

}  // namespace

TEST_CASE("GDML files of a peer's tests run to hits as they are, and no photon is lost") {
  for (const std::string name :
       {"8x8SiPM_w_CSI_optial_grease.gdml", "basic_detector.gdml", "dune_mock_wls_detector_box.gdml",
        "opticks_raindrop.gdml", "test_trap_scint.gdml", "test_trd_scint.gdml", "wls_test.gdml",
        "drich.gdml"}) {
    CAPTURE(name);
    // The RICH is a gas detector of a thousand mirrors and sensors, in which light goes metres.
    const std::string photons = name == "drich.gdml" ? "500" : "10_000";
    const std::optional<SceneSpec> spec = shared_gdml(name, [&photons](std::string& toml) {
      const std::string own = "photons = 10_000";
      const std::size_t at = toml.find(own);
      toml.replace(at, own.size(), "photons = " + photons);
    });
    if (!spec) return;
    const tally::PointResult result = traced_spec(*spec);
    CHECK(result.lost == 0);
    CHECK(result.photons == (name == "drich.gdml" ? 500 : 10'000));
    CHECK(result.count(Fate::detected) > 0);
  }
}

TEST_CASE("GDML: the sphere of wls_test.gdml gives the count that its authors publish") {
  // BNLNPPS/simphony, thread 269: 990 hits of 1,000 photons of 350 nm from the centre along z
  // (wls_test.json), each followed for 31 interactions at most.
  const std::optional<SceneSpec> spec = shared_gdml("wls_test.gdml", [](std::string& toml) {
    const std::size_t from = toml.find("[source]"), to = toml.find("\n\n[", from);
    toml.replace(from, to - from, R"([run]
max_interactions = 31

[source]
type = "photons"
position = ["0 mm", "0 mm", "0 mm"]
direction = [0, 0, 1]
wavelength = "350 nm"
photons = 100_000)");
  });
  if (!spec) return;
  const tally::PointResult result = traced_spec(*spec);
  CHECK(result.lost == 0);
  const Estimate ours = result.fraction(Fate::detected), theirs = binomial_estimate(990, 1000);
  evidence(
      "peer_files",
      {"wls_test.gdml", "photons detected", fmt::format("{:.4f} ± {:.4f}", theirs.value, theirs.error),
       fmt::format("{:.5f} ± {:.5f}", ours.value, ours.error), fmt::format("{:.2f}", sigmas(ours, theirs))});
  CHECK(sigmas(ours, theirs) < kSigmas);
}

TEST_CASE("GDML: the CsI array of 8 x 8 crystals gives the count that its authors publish") {
  // BNLNPPS/simphony, threads 210 and 212: about 240,000 hits of 1,000,000 photons of 420 nm along z from a
  // disc of 0.5 mm in one crystal (8x8SiPM_crystal.json). Hits are of light that enters the sensitive volume,
  // as their macros leave /process/optical/boundary/setInvokeSD off.
  constexpr int kPhotons = 100'000;
  const auto list = scratch_folder("gdml_csi_disc") / "disc.csv";
  {
    std::ofstream stream(list);
    stream << "event,x,y,z,direction_x,direction_y,direction_z,wavelength\n";
    Rng rng(7, StreamKind::other, 0);
    for (int i = 0; i < kPhotons; ++i) {
      const double radius = 0.5 * rng.uniform(), azimuth = kTwoPi * rng.uniform();
      stream << fmt::format("0,{},{},4,0,0,1,420\n", -8.7 + radius * std::cos(azimuth),
                            -8.7 + radius * std::sin(azimuth));
    }
  }
  const std::optional<SceneSpec> spec =
      shared_gdml("8x8SiPM_w_CSI_optial_grease.gdml", [&](std::string& toml) {
        const std::size_t from = toml.find("[source]"), to = toml.find("\n\n[", from);
        toml.replace(from, to - from,
                     "[source]\ntype = \"photon_list\"\nfile = \"" + list.string() +
                         "\"\nlength_unit = \"mm\"\nwavelength_unit = \"nm\"");
        const std::string both = "converts = \"both\"";
        toml.replace(toml.find(both), both.size(), "converts = \"entering\"");
      });
  if (!spec) return;
  const tally::PointResult result = traced_spec(*spec);
  CHECK(result.lost == 0);
  const Estimate ours = result.fraction(Fate::detected);
  constexpr double kPublished = 0.24, kLastDigit = 0.005;
  evidence("peer_files",
           {"8x8SiPM_w_CSI_optial_grease.gdml", "photons detected", "about 0.24",
            fmt::format("{:.5f} ± {:.5f}", ours.value, ours.error),
            fmt::format("{:.2f}", (ours.value - kPublished) / std::hypot(ours.error, kLastDigit))});
  CHECK(std::abs(ours.value - kPublished) < kLastDigit + kSigmas * ours.error);
}
