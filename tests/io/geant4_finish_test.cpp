// Geant4's finishes that are tables: the surface model geant4_table, and its import from GDML. The tables are
// made here, in Geant4's layout; Geant4's own are used where they are present.
#include "scintray/tables/geant4_finish.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

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
#include "scintray/tables/davis.hpp"
#include "scintray/tables/lbnl.hpp"
#include "support/agreement.hpp"
#include "support/environment.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::materials;
using namespace scintray::test;

namespace {

constexpr double kReflected_rad = 0.5, kTransmitted_rad = 0.3;

/// Reflects 1/4 of the light below 45 deg of incidence and 3/4 beyond, forward at 0.5 rad; transmits at 0.3
/// rad.
void write_pair(const std::filesystem::path& folder, const std::string& finish,
                const std::string& extension) {
  const tables::DavisLayout layout;
  std::ofstream shares(folder / (finish + "R" + extension)), pairs(folder / (finish + extension));
  for (int degree = 0; degree < tables::kDavisDegrees; ++degree)
    shares << (degree < 45 ? "0.25\n" : "0.75\n");
  std::string reflected, transmitted;
  for (std::size_t k = 0; k < layout.samples; ++k) {
    reflected += fmt::format("0 {} ", kReflected_rad);
    transmitted += fmt::format("0 {:.6f} ", kPi - kTransmitted_rad);
  }
  for (int block = 0; block < tables::kDavisBlocks; ++block) pairs << reflected << "\n";
  for (int block = 0; block < tables::kDavisBlocks; ++block) pairs << transmitted << "\n";
  pairs << "0\n";
}

/// All light leaves at 30 deg from the normal, forward: theta -30 deg is number 15, phi 0 number 18.
void write_lbnl(const std::filesystem::path& file) {
  const tables::LbnlLayout layout;
  std::vector<int> values(layout.numbers(), 0);
  for (std::size_t incidence = 0; incidence < layout.incidences; ++incidence)
    values[layout.at(incidence, 15, 18)] = 1;
  std::ofstream out(file);
  for (const int value : values) out << value << ' ';
}

const std::filesystem::path& finish_data() {
  static const std::filesystem::path folder = [] {
    const auto made = scratch_folder("real_surface");
    write_pair(made, "Rough_LUT", ".dat");
    write_pair(made, "Customized3_LUT", ".dat");
    write_lbnl(made / "PolishedTeflon.dat");
    return made;
  }();
  return folder;
}

MaterialDatabase finish_database(const std::string& keys, const std::string& file = "scene.toml") {
  MaterialDatabase database = MaterialDatabase::shipped();
  database.add(
      DefinitionKind::surface,
      {{"mine", config::parse_toml("model = \"geant4_table\"\ngeant4_table = { " + keys + " }\n", file)}});
  return database;
}

Surface finish_surface(const std::string& keys) {
  const MaterialDatabase database = finish_database(keys);
  SurfaceFactory factory;
  return factory.make(database.surface("mine"), database.medium("LSO"), database.medium("air"), 420, 400, 500)
      .surface;
}

struct FinishLight {
  std::uint64_t reflected = 0, transmitted = 0, absorbed = 0;
  double polar_rad = 0.0;  ///< of the last reflected photon, negative if backward
};

FinishLight light_at(const Surface& surface, double incidence_rad, Side side = Side::inside) {
  FinishLight light;
  for (std::uint64_t i = 0; i < 20'000; ++i) {
    Rng rng(61, StreamKind::other, i);
    const double into = side == Side::inside ? 1.0 : -1.0;
    Ray ray{Vec3(std::sin(incidence_rad), 0.0, into * std::cos(incidence_rad)), Vec3::UnitY()};
    const SurfaceOutcome outcome = surface.interact(ray, side, Vec3::UnitZ(), {1.82, 1.0}, 420.0, rng);
    if (outcome == SurfaceOutcome::absorbed) {
      ++light.absorbed;
      continue;
    }
    CHECK((outcome == SurfaceOutcome::inside ? ray.direction.z() < 0.0 : ray.direction.z() > 0.0));
    const bool back = outcome == outcome_on(side);
    ++(back ? light.reflected : light.transmitted);
    if (back) light.polar_rad = std::atan2(ray.direction.x(), std::abs(ray.direction.z()));
  }
  return light;
}

void check_share(std::uint64_t count, double share) {
  CHECK(sigmas(binomial_estimate(count, 20'000), {share, 0.0}) < kSigmas);
}

/// The first problem of the definition.
Problem finish_problem(const std::string& keys) {
  try {
    finish_database(keys).surface("mine");
  } catch (const InputError& error) {
    return error.problems().front();
  }
  FAIL("no InputError was thrown");
  return {};
}

bool finish_error(const std::string& keys, const std::string& words) {
  const Problem problem = finish_problem(keys);
  CHECK(problem.where.line == 2);
  CHECK_FALSE(problem.hint.empty());
  if (problem.text().find(words) != std::string::npos) return true;
  MESSAGE(problem.text());
  return false;
}

std::string in_folder(const std::string& keys) {
  return keys + ", folder = \"" + finish_data().string() + "\"";
}

}  // namespace

TEST_CASE("Geant4's finishes are in the order of its enumeration, and have the files of its reader") {
  REQUIRE(tables::lbnl_finishes().size() == 24);
  REQUIRE(tables::davis_finishes().size() == 9);
  CHECK(tables::lbnl_finishes().front() == "polishedlumirrorair");
  CHECK(tables::lbnl_finishes()[2] == "polishedair");
  CHECK(tables::lbnl_finishes()[8] == "etchedlumirrorair");
  CHECK(tables::lbnl_finishes().back() == "groundvm2000glue");
  CHECK(tables::davis_finishes().front() == "Rough_LUT");
  CHECK(tables::davis_finishes().back() == "Detector_LUT");
  CHECK(tables::data_stem("groundlumirrorglue") == "GroundLumirrorGlue");
  CHECK(tables::data_stem("etchedtioair") == "EtchedTiO");
  CHECK(tables::data_stem("PolishedESR_LUT") == "PolishedESR_LUT");
  CHECK_FALSE(tables::data_stem("etchedair"));
  CHECK_FALSE(tables::data_stem("polished"));
}

TEST_CASE(
    "a finish of Davis scatters as its pair has it, transmitted or absorbed, from the folder that is named") {
  const Surface transmits = finish_surface(in_folder("finish = \"Rough_LUT\""));
  CHECK_FALSE(transmits.opaque());
  for (const double degrees : {10.0, 30.5, 60.0, 85.0}) {
    CAPTURE(degrees);
    const FinishLight light = light_at(transmits, degrees * kDegree);
    const double share = degrees < 45.0 ? 0.25 : 0.75;
    check_share(light.reflected, share);
    check_share(light.transmitted, 1.0 - share);
    CHECK(light.polar_rad == doctest::Approx(kReflected_rad).epsilon(1e-3));
  }
  const Surface absorbs = finish_surface(in_folder("finish = \"Rough_LUT\", unreflected = \"absorbed\""));
  CHECK(absorbs.opaque());
  check_share(light_at(absorbs, 0.3).absorbed, 0.75);
}

TEST_CASE("light from outside at a finish is what the surface states, Fresnel's equations without a word") {
  const auto back = [](const std::string& words) {
    return light_at(finish_surface(in_folder("finish = \"Rough_LUT\"" + words)), 0.3, Side::outside);
  };
  const FinishLight smooth = back("");
  check_share(smooth.reflected, fresnel(std::cos(0.3), 1.0, 1.82).reflectance_s);
  CHECK(smooth.absorbed == 0);
  CHECK(back(", from_outside = \"mirror\"").reflected == 20'000);
  CHECK(back(", from_outside = \"absorb\"").absorbed == 20'000);
  const FinishLight same = back(", from_outside = \"same\"");
  check_share(same.reflected, 0.25);
  check_share(same.transmitted, 0.75);
  CHECK(same.polar_rad == doctest::Approx(kReflected_rad).epsilon(1e-3));
}

TEST_CASE(
    "a finish of LBNL has the reflectance that is given; G4REALSURFACEDATA names the folder as for Geant4") {
  const ScopedVariable data(tables::kSurfaceDataVariable, finish_data().string());
  const Surface surface = finish_surface("finish = \"polishedteflonair\", reflectance = 0.9");
  CHECK(surface.opaque());
  const FinishLight light = light_at(surface, 0.8);
  check_share(light.reflected, 0.9);
  check_share(light.absorbed, 0.1);
  CHECK(light.polar_rad == doctest::Approx(30.0 * kDegree).epsilon(0.02));
}

TEST_CASE("a finish without its folder, file or data is an error at its place, with what to write") {
  const ScopedVariable none(tables::kSurfaceDataVariable, std::nullopt);
  CHECK(finish_error("finish = \"Rough_LUT\"", "G4REALSURFACEDATA"));
  CHECK(finish_error("finish = \"Rough_LUT\", folder = \"no/such/folder\"", "does not exist"));
  CHECK(finish_error(in_folder("finish = \"RoughESR_LUT\""),
                     "neither \"RoughESR_LUT.z\" nor \"RoughESR_LUT.dat\""));
  CHECK(finish_error(in_folder("finish = \"groundair\""), "bare face"));
  CHECK(finish_error(in_folder("finish = \"Ruogh_LUT\""), "Rough_LUT"));
  CHECK(finish_error(in_folder("finish = \"Rough_LUT\", reflectance = 0.9"), "has its own"));
  CHECK(finish_error(in_folder("finish = \"polishedteflonair\", reflectance = 95"), "share above 0"));
  CHECK(finish_error(in_folder("finish = \"polishedteflonair\", unreflected = \"absorbed\""),
                     "transmits nothing"));
  const auto damaged = scratch_folder("real_surface_damaged");
  write_lbnl(damaged / "EtchedTiO.dat");
  std::ofstream(damaged / "GroundTiO.dat") << "0.5 0.5 nothing";
  CHECK(finish_error("finish = \"groundtioair\", folder = \"" + damaged.string() + "\"", "nothing"));
  CHECK_NOTHROW(
      finish_database("finish = \"etchedtioair\", folder = \"" + damaged.string() + "\"").surface("mine"));
}

namespace {

/// A beam of 40,000 photons on the face between two blocks, from the first, whose skin is the surface.
GdmlText finish_blocks(const std::string& attributes, const std::string& properties) {
  GdmlText text;
  text.define = R"(<matrix name="R80" coldim="2" values="2*eV 0.8 4*eV 0.8"/>
<matrix name="RISING" coldim="2" values="2*eV 0.5 4*eV 0.9"/><matrix name="E1" coldim="2" values="2*eV 1 4*eV 1"/>
)";
  text.solids = R"(<box name="cube" x="10" y="10" z="10"/><opticalsurface name="it" )" + attributes +
                R"( value="0">)" + properties + "</opticalsurface>";
  text.structure =
      gdml_volume("one_v", "cube") + gdml_volume("two_v", "cube") +
      R"(<bordersurface name="b" surfaceproperty="it"><physvolref ref="one"/><physvolref ref="two"/></bordersurface>)";
  text.daughters = gdml_placed("one", "one_v") + gdml_placed("two", "two_v", R"(<position z="10"/>)");
  return text;
}

std::string finish_draft(const GdmlText& text) {
  return exchange::gdml::draft_of_gdml(text.text(), "test.gdml", {}).toml;
}

}  // namespace

TEST_CASE("GDML: surfaces of LUT and DAVIS name Geant4's tables, by words or by numbers") {
  const auto has = [](const std::string& text, const std::string& words) {
    if (text.find(words) != std::string::npos) return true;
    MESSAGE(text);
    return false;
  };
  const std::string davis =
      finish_draft(finish_blocks(R"(model="DAVIS" type="dielectric_LUTDAVIS" finish="Rough_LUT")", ""));
  CHECK(has(davis, "geant4_table = { finish = \"Rough_LUT\", from_outside = \"same\" }"));
  CHECK(has(davis, "G4REALSURFACEDATA"));
  CHECK(has(finish_draft(finish_blocks(R"(model="3" type="3" finish="30")",
                                       R"(<property name="EFFICIENCY" ref="E1"/>)")),
            "finish = \"Rough_LUT\", from_outside = \"same\", unreflected = \"absorbed\""));
  CHECK(has(finish_draft(finish_blocks(R"(model="LUT" type="dielectric_LUT" finish="etchedvm2000glue")",
                                       R"(<property name="REFLECTIVITY" ref="R80"/>)")),
            "finish = \"etchedvm2000glue\", from_outside = \"same\", reflectance = 0.8"));
  const std::string rising = finish_draft(
      finish_blocks(R"(model="2" type="2" finish="9")", R"(<property name="REFLECTIVITY" ref="RISING"/>)"));
  CHECK(has(rising, "finish = \"polishedteflonair\", from_outside = \"same\" }"));
  CHECK(has(rising, "admitted = "));
  CHECK(has(rising, "drawn once a reflection"));
  CHECK(has(finish_draft(finish_blocks(R"(model="LUT" type="dielectric_LUT" finish="groundair")", "")),
            "for which Geant4 has no table"));
}

TEST_CASE("GATE: the customized finishes of its files are pairs of the user's by their names") {
  CHECK(tables::data_stem("CustomizedDetector_LUT") == "CustomizedDetector_LUT");
  CHECK(tables::customized_finishes().size() == 6);
  const auto file = scratch_folder("customized") / "SurfaceProperties.xml";
  std::ofstream(file) << R"(<surfaces><surface model="DAVIS" name="mine" type="dielectric_LUTDAVIS" )"
                      << R"(finish="Customized3_LUT"></surface></surfaces>)";
  const exchange::SceneDraft draft = exchange::gate::definitions_of_gate(file, {});
  CHECK(draft.toml.find("geant4_table = { finish = \"Customized3_LUT\"") != std::string::npos);
  CHECK(draft.toml.find("Geant4 itself has no finish") != std::string::npos);
  const ScopedVariable data(tables::kSurfaceDataVariable, finish_data().string());
  const FinishLight light = light_at(finish_surface("finish = \"Customized3_LUT\""), 0.2);
  CHECK(sigmas(binomial_estimate(light.reflected, 20'000), {0.25, 0.0}) < kSigmas);
  CHECK(finish_problem("finish = \"Customized2_LUT\"").text().find("Customized2_LUT.z") != std::string::npos);
}

TEST_CASE("GDML: a border of DAVIS runs with Geant4's data, and without is an error that names them") {
  exchange::gdml::GdmlImport options;
  exchange::SceneDraft draft = exchange::gdml::draft_of_gdml(
      finish_blocks(R"(model="DAVIS" type="dielectric_LUTDAVIS" finish="Rough_LUT")", "").text(), "test.gdml",
      options);
  const std::size_t from = draft.toml.find("[source]"), to = draft.toml.find("\n\n[", from);
  draft.toml.replace(
      from, to - from,
      "[source]\ntype = \"photons\"\nposition = [\"0 mm\", \"0 mm\", \"0 mm\"]\ndirection = [0, 0.5, "
      "0.8660254037844386]\nwavelength = \"420 nm\"\nphotons = 20_000\n");
  const auto file = scratch_folder("gdml_finish") / "scene.toml";
  exchange::write_scene_draft(draft, file);
  {
    const ScopedVariable none(tables::kSurfaceDataVariable, std::nullopt);
    scene::SceneBuilder builder;
    CHECK_THROWS_WITH_AS(builder.build(scene_file::SceneFile::load(file).spec(0)),
                         doctest::Contains("G4REALSURFACEDATA"), InputError);
  }
  const ScopedVariable data(tables::kSurfaceDataVariable, finish_data().string());
  scene::SceneBuilder builder;
  const simulation::SimulationPoint point(scene_file::SceneFile::load(file).spec(0), builder);
  const tally::PointResult result = point.trace({});
  CHECK(result.lost == 0);
  CHECK(result.photons == 20'000);
}

TEST_CASE("Geant4's own tables can be read, every finish that is there") {
  const char* named = std::getenv(tables::kSurfaceDataVariable);
  std::optional<std::filesystem::path> folder;
  if (named != nullptr && *named != '\0') folder = named;
  if (!folder) folder = shared_file("data/RealSurface");
  if (!folder) return;
  std::vector<std::string> finishes = tables::davis_finishes();
  finishes.insert(finishes.end(), tables::lbnl_finishes().begin(), tables::lbnl_finishes().end());
  for (const std::string& finish : finishes)
    if (tables::data_stem(finish)) {
      CAPTURE(finish);
      const Surface surface =
          finish_surface("finish = \"" + finish + "\", folder = \"" + folder->string() + "\"");
      const FinishLight light = light_at(surface, 0.5);
      CHECK(light.reflected > 0);
    }
}
