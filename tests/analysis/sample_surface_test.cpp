#include "scintray/analysis/goniometer/sample_surface.hpp"

#include <doctest/doctest.h>

#include "scintray/core/error.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/optics/facets.hpp"
#include "scintray/optics/height_field.hpp"
#include "scintray/optics/table.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::config;
using namespace scintray::optics;
using namespace scintray::materials;
using namespace scintray::analysis;
using namespace scintray::test;

namespace {

std::string refusal(const SamplePlace& place) {
  SurfaceFactory factory;
  return complaint_of([&] { make_sample_surface(MaterialDatabase::shipped(), factory, place); });
}

}  // namespace

TEST_CASE("a surface comes with the indices of its media at the wavelength, and its sources") {
  SurfaceFactory factory;
  const SampleSurface goniometer =
      make_sample_surface(MaterialDatabase::shipped(), factory,
                          {"polished", "LSO_roncali2013", "optical_grease_roncali2013", 420.0});
  CHECK(goniometer.index.inside == 1.82);
  CHECK(goniometer.index.outside == 1.5);
  CHECK(goniometer.surface.name == "polished");
  CHECK(goniometer.sources.size() == 1);
}

TEST_CASE("unknown names are errors with the nearest ones, all at once") {
  const std::string text = refusal({"lso_polish", "LS0", "airr", 420.0});
  CHECK(contains(text, "no surface \"lso_polish\""));
  CHECK(contains(text, "\"lso_polished\"?"));
  CHECK(contains(text, "no medium \"LS0\""));
  CHECK(contains(text, "\"LSO\"?"));
  CHECK(contains(text, "\"air\"?"));
}

TEST_CASE("a wavelength at which a medium has no index is refused with the range that it has") {
  const std::string text = refusal({"polished", "LSO", "air", 900.0});
  CHECK(contains(text, "medium \"LSO\" has refractive indices from 350 to 700 nm"));
  CHECK(contains(text, "900 nm"));
  CHECK(contains(refusal({"polished", "LSO", "air", -5.0}), "expected more than 0"));
}

TEST_CASE("a surface that leaves something to the user is refused with what it needs") {
  CHECK(contains(refusal({"geant4_ground", "LSO", "air", 420.0}), "unified.sigma_alpha"));
}

TEST_CASE("of a mixture every part is traced on its map, and checked for the wavelength") {
  const auto document = parse_toml(R"(
[half]
mixture = [{ surface = "lso_polished", share = 0.5 }, { surface = "glued", share = 0.5 }]
[glued]
model = "smooth"
gap = "short"
reflector = "lambertian_097"
)",
                                   "scene.toml");
  const auto medium = parse_toml(R"(
[short.index]
n = { wavelength = ["400 nm", "430 nm"], value = [1.5, 1.5] }
[short.absorption]
none = true
[short.scattering]
none = true
)",
                                 "scene.toml");
  MaterialDatabase database = MaterialDatabase::shipped();
  for (const char* name : {"half", "glued"})
    database.add(DefinitionKind::surface, {{name, std::make_shared<const TomlNode>(*document->find(name))}});
  database.add(DefinitionKind::medium, {{"short", std::make_shared<const TomlNode>(*medium->find("short"))}});

  CHECK(database.outline("half").model == "mixture");
  SurfaceFactory factory;
  const SampleSurface goniometer =
      make_sample_surface(database, factory, {"half", "LSO", "air", 420.0}, true);
  REQUIRE(goniometer.surface.mixture.size() == 2);
  CHECK(goniometer.surface.mixture.front().surface->microsurface.get_if<HeightField>() != nullptr);
  CHECK_THROWS_AS(mean_visible_slope(goniometer.surface, Side::inside, 0.5), InputError);
  try {
    make_sample_surface(database, factory, {"half", "LSO", "air", 500.0}, true);
    FAIL("a gap without an index was accepted");
  } catch (const InputError& error) {
    CHECK(contains(error.problems().front().text(), "the gap of surface \"glued\""));
  }
}

TEST_CASE("presets have the source of their definition as well") {
  const MaterialDatabase database = MaterialDatabase::shipped();
  const SurfaceOutline preset = database.outline("geant4_ground");
  CHECK(preset.model == "unified");
  CHECK(preset.needs.size() == 4);
  CHECK(preset.bases.empty());
  const SurfaceOutline derived = database.outline("lso_ground_30um_lambertian_097");
  CHECK(derived.model == "recipe");
  CHECK(derived.bases == std::vector<std::string>{"lso_ground_30um"});
  CHECK(derived.needs.empty());
  CHECK(derived.sources.size() == 2);
  CHECK_THROWS_AS(database.outline("nothing_like_it"), InputError);
}

TEST_CASE("visible slopes: none on a flat face, of a table as of its map, not available without facets") {
  CHECK(mean_visible_slope(Surface{}, Side::inside, 0.5).value == 0.0);
  Surface facets;
  facets.microsurface = FacetSurface{};
  CHECK_THROWS_AS(mean_visible_slope(facets, Side::inside, 0.5), InputError);

  TableNode low, high;
  low.mean_slope_rad = 0.2;
  low.transmitted.rays = high.transmitted.rays = 1;
  high.incidence_rad = 0.5 * kPi;
  high.mean_slope_rad = 0.4;
  low.reflectance = high.reflectance = 1.0;
  std::vector<ExitAngles> up{{0.1f, 0.1f}, {0.2f, 0.3f}};
  low.reflected = high.reflected = quantiles_of(up);
  Surface table;
  table.microsurface = std::make_shared<const SurfaceTable>(
      SurfaceTable({1.82, 1.0}, {low, high}, {low, high}, TableProvenance{}));
  CHECK(mean_visible_slope(table, Side::inside, 0.125 * kPi).value == doctest::Approx(0.25));
  TableProvenance stack;
  stack.stack = "with its reflector";
  table.microsurface =
      std::make_shared<const SurfaceTable>(SurfaceTable({1.82, 1.0}, {low, high}, {low, high}, stack));
  CHECK_THROWS_AS(mean_visible_slope(table, Side::inside, 0.5), InputError);
}
