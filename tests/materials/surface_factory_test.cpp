/// Surfaces between media: tables used beyond their indices and wavelengths, stacks on stacks, mixtures.

#include <doctest/doctest.h>

#include "database_helpers.hpp"
#include "scintray/materials/database.hpp"
#include "scintray/materials/surface_factory.hpp"
#include "scintray/topography/build_table.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::config;
using namespace scintray::optics;
using namespace scintray::topography;
using namespace scintray::materials;

namespace {

/// Index 1.8 at 400 nm, 1.6 at 600 nm.
Medium dispersive() {
  Medium medium;
  medium.name = "dispersive";
  medium.index = Curve({400.0, 600.0}, {1.8, 1.6});
  return medium;
}

Medium air() {
  Medium medium;
  medium.name = "air";
  medium.index = Curve::constant(1.0);
  return medium;
}

SurfaceSpec small_relief(std::vector<double> wavelengths_nm) {
  RecipeSpec recipe;
  recipe.recipe.gaussian = {0.1, 1.0};
  recipe.recipe.columns = recipe.recipe.rows = 64;
  TracingSpec tracing;
  tracing.settings.rays = 20;
  tracing.settings.incidence_step_rad = 30.0 * kDegree;
  tracing.settings.refine = false;
  tracing.wavelengths_nm = std::move(wavelengths_nm);
  recipe.table = tracing;
  SurfaceSpec spec;
  spec.name = "small";
  spec.microsurface = recipe;
  return spec;
}

SurfaceFactory factory_without_cache() {
  SurfaceFactory::Hooks hooks;
  hooks.cache.clear();
  return SurfaceFactory(hooks);
}

std::vector<std::string> warnings(const SurfaceSpec& spec, double low_nm, double high_nm) {
  return factory_without_cache().make(spec, dispersive(), air(), 500.0, low_nm, high_nm).warnings;
}

std::string message(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST_CASE("a table for one wavelength warns when dispersion leaves it behind; one for several follows") {
  CHECK(warnings(small_relief({}), 495.0, 505.0).empty());
  const auto one = warnings(small_relief({}), 420.0, 560.0);
  REQUIRE(one.size() == 1);
  CHECK(one[0].find("tracing.wavelengths") != std::string::npos);
  CHECK(one[0].find("420 to 560 nm") != std::string::npos);
  CHECK(warnings(small_relief({420.0, 490.0, 560.0}), 420.0, 560.0).empty());
}

TEST_CASE("a table used beyond its wavelengths warns") {
  CHECK(warnings(small_relief({480.0, 520.0}), 480.0, 520.0).empty());
  CHECK(warnings(small_relief({480.0, 520.0}), 420.0, 520.0).size() == 1);
}

TEST_CASE("a table file of other indices is refused, and so is a stack laid on a stack") {
  const auto folder = test::scratch_folder("surface_maker");
  TableSettings settings = microsurface_of<RecipeSpec>(small_relief({})).table->settings;
  Surface lossy;
  lossy.reflector = Reflector{"ESR", Curve::constant(0.9), 1.0};
  TableProvenance provenance;
  provenance.stack = "smooth | air | ESR";
  write_table(folder / "stack.h5", build_stack_table(lossy, {{500.0, {1.7, 1.0}}}, settings, provenance));
  write_table(folder / "other.h5", build_stack_table(Surface{}, {{500.0, {1.5, 1.0}}}, settings));

  SurfaceSpec spec;
  spec.name = "from a file";
  spec.microsurface = TableFileSpec{folder / "other.h5", {}};
  const auto make = [&] { factory_without_cache().make(spec, dispersive(), air(), 500.0, 500.0, 500.0); };
  CHECK(message(make).find("is for indices 1.5000 to 1.0000") != std::string::npos);
  spec.microsurface = TableFileSpec{folder / "stack.h5", {}};
  CHECK(message(make).empty());
  spec.reflector = Reflector{"PTFE", Curve::constant(0.9), 0.0};
  CHECK(message(make).find("smooth | air | ESR") != std::string::npos);
}

TEST_CASE("mixtures are read from the database, with shares that sum to one and without themselves") {
  const auto database_with = [](const std::string& text) {
    Problems problems;
    MaterialDatabase database = MaterialDatabase::shipped();
    std::map<std::string, TomlNodePtr> definitions;
    const TomlNodePtr document = parse_toml(text, "mix.toml");
    for (const TomlNode& surface : document->find("surfaces")->items)
      definitions[surface.key] = std::make_shared<const TomlNode>(surface);
    database.add(DefinitionKind::surface, definitions);
    return database;
  };
  const SurfaceSpec good = database_with(R"(
[surfaces.half]
mixture = [{ surface = "lso_polished_esr_air", share = 0.4 }, { surface = "lso_polished_esr_grease", share = 0.6 }]
)")
                               .surface("half");
  REQUIRE(good.mixture.size() == 2);
  CHECK(good.mixture[1].share == 0.6);
  CHECK(good.mixture[1].surface->gap == "optical_grease");

  const auto complaint = [&](const std::string& text) {
    return message([&] { database_with("[surfaces.half]\n" + text).surface("half"); });
  };
  CHECK(complaint("mixture = [{ surface = \"polished\", share = 0.4 }]").find("sum to 0.4") !=
        std::string::npos);
  const SurfaceSpec rest = database_with(
                               "[surfaces.rest]\nmixture = [{ surface = \"polished\" }, { surface = "
                               "\"lso_polished\", share = 0.3 }]\n")
                               .surface("rest");
  REQUIRE(rest.mixture.size() == 2);
  CHECK(rest.mixture[0].share == doctest::Approx(0.7));
  CHECK(rest.mixture[1].share == 0.3);
  CHECK(
      complaint(
          "mixture = [{ surface = \"polished\", share = 0.6 }, { surface = \"lso_polished\", share = 0.7 }, "
          "{ surface = \"lso_polished\" }]")
          .find("sum to 1.3") != std::string::npos);
  CHECK(complaint("mixture = [{ surface = \"polished\" }, { surface = \"lso_polished\" }]")
            .find("only one can take") != std::string::npos);
  CHECK(complaint("mixture = [{ surface = \"half\", share = 1.0 }]").find("mixture of itself") !=
        std::string::npos);
  CHECK(complaint("model = \"smooth\"\nmixture = [{ surface = \"polished\", share = 1.0 }]")
            .find("whole surfaces") != std::string::npos);
}
