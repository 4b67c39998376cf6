// Geant4's dichroic surfaces: their file, the surface of it, and the import from GDML.
#include <doctest/doctest.h>

#include <cmath>
#include <fstream>

#include "io/gdml_texts.hpp"
#include "scintray/core/statistics.hpp"
#include "scintray/exchange/scene_draft.hpp"
#include "scintray/materials/database.hpp"
#include "scintray/materials/surface_factory.hpp"
#include "scintray/scene/build_scene.hpp"
#include "scintray/scene_file/read_scene.hpp"
#include "scintray/simulation/simulation_point.hpp"
#include "scintray/tables/geant4_finish.hpp"
#include "support/agreement.hpp"
#include "support/environment.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::materials;
using namespace scintray::test;

namespace {

/// 90 % at 400 nm and 10 % at 500 nm at normal incidence, 50 % and 20 % at 60 deg.
constexpr const char* kFilter = "4 2 2\n400 500\n0 60\n90 10\n50 20\n";

std::filesystem::path filter_file(const std::string& name, const std::string& content = kFilter) {
  const auto file = scratch_folder("dichroic_" + name) / "filter.dat";
  std::ofstream(file) << content;
  return file;
}

MaterialDatabase filter_database(const std::string& keys) {
  MaterialDatabase database = MaterialDatabase::shipped();
  database.add(
      DefinitionKind::surface,
      {{"mine",
        config::parse_toml("model = \"angular\"\nangular = { transmitted = \"undeflected\", " + keys + " }\n",
                           "scene.toml")}});
  return database;
}

}  // namespace

TEST_CASE(
    "a dichroic surface transmits the percents of Geant4's file at the whole degree, and reflects the rest") {
  const auto file = filter_file("surface");
  for (const bool lambertian : {false, true}) {
    const MaterialDatabase database =
        filter_database(std::string(lambertian ? "reflected = \"lambertian\", " : "") +
                        "geant4_dichroic = { file = \"" + file.string() + "\" }");
    SurfaceFactory factory;
    const Surface surface =
        factory.make(database.surface("mine"), database.medium("LSO"), database.medium("air"), 420, 300, 600)
            .surface;
    struct Case {
      double nm, degrees, transmitted;
    };
    // 15.4 deg counts as 15, 15.5 as 16; beyond the table its ends go on (G4Physics2DVector::Value).
    for (const Case& c : {Case{400, 0, 0.9}, Case{450, 0, 0.5}, Case{400, 15.4, 0.9 - 0.4 * 15 / 60},
                          Case{400, 15.6, 0.9 - 0.4 * 16 / 60}, Case{450, 30, 0.425}, Case{450, 80, 0.35},
                          Case{350, 0, 0.9}, Case{550, 60, 0.2}}) {
      CAPTURE(c.nm);
      CAPTURE(c.degrees);
      constexpr std::uint64_t kRays = 40'000;
      std::uint64_t transmitted = 0, deflected = 0, absorbed = 0, mirrored = 0;
      const Vec3 before(std::sin(c.degrees * kDegree), 0.0, std::cos(c.degrees * kDegree));
      for (std::uint64_t i = 0; i < kRays; ++i) {
        Rng rng(62, StreamKind::other, i);
        Ray ray{before, Vec3::Zero()};
        const SurfaceOutcome outcome =
            surface.interact(ray, Side::inside, Vec3::UnitZ(), {1.82, 1.0}, c.nm, rng);
        absorbed += outcome == SurfaceOutcome::absorbed;
        transmitted += outcome == SurfaceOutcome::outside;
        if (outcome == SurfaceOutcome::outside) deflected += !ray.direction.vec().isApprox(before, 1e-12);
        if (outcome == SurfaceOutcome::inside)
          mirrored += ray.direction.vec().isApprox(Vec3(before.x(), 0.0, -before.z()), 1e-9);
      }
      CHECK(absorbed == 0);
      CHECK(deflected == 0);
      CHECK(mirrored == (lambertian ? 0 : kRays - transmitted));
      CHECK(sigmas(binomial_estimate(transmitted, kRays), {c.transmitted, 0.0}) < kSigmas);
    }
  }
}

TEST_CASE("dichroic files that lie are refused with the file, what was found and the format") {
  const auto of = [](const std::string& content) {
    const std::vector<Problem> problems = problems_of([&] { tables::parse_dichroic(content, "filter.dat"); });
    for (const Problem& problem : problems) CHECK_FALSE(problem.hint.empty());
    return complaint_of([&] { tables::parse_dichroic(content, "filter.dat"); });
  };
  CHECK(of(kFilter).empty());
  check_contains(of("4 2 2\n400 500\n0 60\n90 10\n50\n"), {"filter.dat", "10 numbers"});
  check_contains(of("4 3 2\n400 450 500\n0 60\n90 50 10\n50 20\n"), {"filter.dat", "14 numbers", "13"});
  check_contains(of("4 2 2\n400 500\n0 60\n90 10\n50 20 30\n"), {"11 numbers", "12"});
  check_contains(of("4 1 2\n400\n0 60\n90\n50 1 1 1 1\n"), {"filter.dat", "1 wavelengths", "2 or more"});
  check_contains(of("4 2 2.5\n400 500\n0 60\n90 10\n50 20\n"), {"2.5 angles"});
  check_contains(of("4 2 2\n500 400\n0 60\n90 10\n50 20\n"), {"wavelengths", "rise", "number 2 is 400"});
  check_contains(of("4 2 2\n0.4 0.5\n0 60\n90 10\n50 20\n"), {"wavelengths", "0.4"});
  check_contains(of("4 2 2\n400 500\n0 100\n90 10\n50 20\n"), {"angles", "number 2 is 100"});
  check_contains(of("4 2 2\n400 500\n0 60\n90 10\n50 120\n"), {"500 nm", "60 deg", "120", "percent"});
  check_contains(of("# a filter\n4 2 2\n400 500\n0 60\n90 10\n50 20\n"), {"filter.dat", "#"});
  const auto wrong = [](const std::string& keys) {
    const MaterialDatabase database = filter_database(keys);
    return complaint_of([&] { database.surface("mine"); });
  };
  const ScopedVariable none(tables::kDichroicVariable, std::nullopt);
  check_contains(wrong("geant4_dichroic = {}"), {"scene.toml:2:", "G4DICHROICDATA"});
  check_contains(wrong("geant4_dichroic = { file = \"gone.dat\" }"), {"scene.toml:2:", "gone.dat"});
  const auto file = filter_file("both");
  check_contains(wrong("at = [{ angle = \"0 deg\", reflectance = 1 }], geant4_dichroic = { file = \"" +
                       file.string() + "\" }"),
                 {"scene.toml:2:", "rows and a table"});
  const auto short_file = filter_file("short", "4 2 2 400");
  check_contains(wrong("geant4_dichroic = { file = \"" + short_file.string() + "\" }"),
                 {"scene.toml:2:", "filter.dat"});
}

TEST_CASE("GDML: a dichroic border runs with the file that G4DICHROICDATA names") {
  GdmlText text;
  text.solids = R"(<box name="cube" x="10" y="10" z="10"/><opticalsurface name="it" model="4" finish="0" )"
                R"(type="4" value="0"/>)";
  text.structure =
      gdml_volume("one_v", "cube") + gdml_volume("two_v", "cube") +
      R"(<bordersurface name="b" surfaceproperty="it"><physvolref ref="one"/><physvolref ref="two"/></bordersurface>)";
  text.daughters = gdml_placed("one", "one_v") + gdml_placed("two", "two_v", R"(<position z="10"/>)");
  exchange::SceneDraft draft = exchange::gdml::draft_of_gdml(text.text(), "test.gdml", {});
  CHECK(draft.missing.empty());
  check_contains(draft.toml, "geant4_dichroic = {}");
  REQUIRE(draft.notes.size() == 1);
  check_contains(draft.notes[0], "G4DICHROICDATA");
  const std::size_t from = draft.toml.find("[source]"), to = draft.toml.find("\n\n[", from);
  draft.toml.replace(
      from, to - from,
      "[source]\ntype = \"photons\"\nposition = [\"0 mm\", \"0 mm\", \"0 mm\"]\ndirection = [0, 0, 1]\n"
      "wavelength = \"450 nm\"\nphotons = 20_000\n");
  const auto scene = scratch_folder("dichroic_gdml") / "scene.toml";
  exchange::write_scene_draft(draft, scene);
  scene::SceneBuilder builder;
  {
    const ScopedVariable none(tables::kDichroicVariable, std::nullopt);
    CHECK_THROWS_WITH_AS(builder.build(scene_file::SceneFile::load(scene).spec(0)),
                         doctest::Contains("G4DICHROICDATA"), InputError);
  }
  const ScopedVariable data(tables::kDichroicVariable, filter_file("of_gdml").string());
  const simulation::SimulationPoint point(scene_file::SceneFile::load(scene).spec(0), builder);
  const tally::PointResult result = point.trace({});
  CHECK(result.lost == 0);
  CHECK(result.photons == 20'000);
}

TEST_CASE("GDML: coated faces and paint that passes light have the options of Geant4's boundary process") {
  const auto toml = [](const std::string& surface) {
    GdmlText text =
        gdml_solid(R"(<box name="it" x="4" y="2" z="2"/><opticalsurface name="f" model="unified" )" +
                   surface + "</opticalsurface>");
    text.define = R"(<matrix name="CI" coldim="2" values="2*eV 1.7 4*eV 1.7"/>
<matrix name="CT" coldim="1" values="100*nm"/><matrix name="ON" coldim="1" values="1"/>
<matrix name="S" coldim="2" values="2*eV 0.3 4*eV 0.3"/><matrix name="R" coldim="2" values="2*eV 0.8 4*eV 0.8"/>)";
    text.structure += R"(<skinsurface name="s" surfaceproperty="f"><volumeref ref="body"/></skinsurface>)";
    return exchange::gdml::draft_of_gdml(text.text(), "test.gdml", {}).toml;
  };
  const std::string film =
      R"(finish="polished" type="coated" value="0"><property name="COATEDRINDEX" ref="CI"/>)"
      R"(<property name="COATEDTHICKNESS" ref="CT"/>)";
  const std::string efficiency = R"(<property name="EFFICIENCY" ref="S"/>)";
  check_contains(toml(film), "frustrated_transmission = false }");
  CHECK_FALSE(
      contains(toml(film + R"(<property name="COATEDFRUSTRATEDTRANSMISSION" ref="ON"/>)"), "frustrated"));
  check_contains(toml(film + efficiency), "transmits = false");
  check_contains(toml(film + efficiency), "[sensors.\"f sensor\"]");
  // One number decides: of the light that comes to the paint at most 0.2 pass it.
  const std::string paint = R"(finish="groundbackpainted" type="dielectric_dielectric" value="0.1">)"
                            R"(<property name="RINDEX" ref="CI"/><property name="REFLECTIVITY" ref="R"/>)";
  const std::string passing = toml(paint + R"(<property name="TRANSMITTANCE" ref="S"/>)");
  check_contains(passing, "transmitted_light = \"undeflected\"");
  check_contains(passing.substr(passing.find("\ntransmittance = ")), "value = [0.2, 0.2]");
  CHECK_FALSE(contains(toml(paint), "transmitted_light"));
}

TEST_CASE("GDML: a rough dichroic face reflects by Lambert's law, as Geant4 without UNIFIED's lobes") {
  const auto toml = [](const std::string& attributes) {
    GdmlText text = gdml_solid(R"(<box name="it" x="4" y="2" z="2"/><opticalsurface name="f" )" + attributes +
                               R"( type="dielectric_dichroic" value="0.1"/>)");
    text.structure += R"(<skinsurface name="s" surfaceproperty="f"><volumeref ref="body"/></skinsurface>)";
    return exchange::gdml::draft_of_gdml(text.text(), "test.gdml", {}).toml;
  };
  CHECK(contains(toml(R"(model="dichroic" finish="ground")"), "reflected = \"lambertian\""));
  CHECK_FALSE(contains(toml(R"(model="dichroic" finish="polished")"), "lambertian"));
  CHECK_FALSE(contains(toml(R"(model="glisur" finish="polished")"), "lambertian"));
}
