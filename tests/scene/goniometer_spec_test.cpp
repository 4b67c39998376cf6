// [[bench]] and acceptance criteria about its surfaces: values read, and messages about mistakes.
#include "scintray/scene_file/goniometer.hpp"

#include <doctest/doctest.h>

#include "scintray/scene_file/criterion.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::config;
using namespace scintray::scene_file;
using namespace scintray::test;

namespace {

const std::string kPlainGoniometer = R"([[bench]]
surfaces = ["polished", "ground"]
inside = "LSO"
outside = ["air"]
wavelength = "420 nm"
)";

std::vector<GoniometerSpec> goniometers_of(const std::string& text) {
  Problems problems;
  const TomlTable root(parse_toml(text, "scene.toml"), problems);
  std::vector<GoniometerSpec> goniometers = read_goniometers(root);
  root.finish();
  problems.throw_if_any();
  return goniometers;
}

std::string problems_of_goniometer(const std::string& more) {
  return complaint_of([&] { goniometers_of(kPlainGoniometer + more); });
}

CriterionSpec criterion_on_surface(const std::string& body) {
  return criteria_of_text("[[claim]]\ntext = \"what is said\"\n" + body, "scene.toml").at(0);
}

}  // namespace

TEST_CASE("A goniometer without optional keys measures from normal to grazing incidence") {
  const GoniometerSpec goniometer = goniometers_of(kPlainGoniometer).at(0);
  REQUIRE(goniometer.surfaces.size() == 2);
  CHECK(goniometer.surfaces[1].name == "ground");
  CHECK(goniometer.surfaces[1].where.line == 2);
  CHECK(goniometer.inside.name == "LSO");
  CHECK(goniometer.outside.at(0).name == "air");
  CHECK(goniometer.wavelength_nm == 420.0);
  CHECK(goniometer.rays == 100'000);
  CHECK(goniometer.directions_at_rad == doctest::Approx(45.0 * kDegree));
  REQUIRE(goniometer.incidence_rad.size() == 37);
  CHECK(goniometer.incidence_rad.front() == 0.0);
  CHECK(goniometer.incidence_rad[18] == doctest::Approx(45.0 * kDegree));
  CHECK(goniometer.incidence_rad.back() == doctest::Approx(88.5 * kDegree));
}

TEST_CASE("Mistakes in a goniometer are reported with their place") {
  check_contains(problems_of_goniometer("incidence = [\"40 deg\", \"20 deg\"]\n"), "scene.toml:6:");
  check_contains(problems_of_goniometer("incidence = [\"40 deg\", \"20 deg\"]\n"),
                 "angles of incidence rise");
  check_contains(problems_of_goniometer("incidence = [\"90 deg\"]\n"), "below 90 deg");
  check_contains(problems_of_goniometer("directions_at = \"-1 deg\"\n"), "below 90 deg");
  check_contains(problems_of_goniometer("rays = 10\n"), "1,000 to 100,000,000");
  check_contains(problems_of_goniometer("ray = 10\n"), "rays");
  check_contains(complaint_of([] { goniometers_of("[[bench]]\nsurfaces = [\"polished\"]\n"); }), "inside");
}

TEST_CASE("Acceptance criteria about surfaces have bounds in the unit of their quantity") {
  const CriterionSpec slope = criterion_on_surface(
      "quantity = \"mean_slope\"\nsurface = \"ground\"\noutside = \"air\"\nincidence = \"0 deg\"\n"
      "at_least = \"17 deg\"\n");
  CHECK(is_of_surface(slope.quantity));
  CHECK(slope.at_least.value() == doctest::Approx(17.0 * kDegree));
  const CriterionSpec share = criterion_on_surface(
      "quantity = \"over_fresnel\"\nsurface = \"ground\"\noutside = \"air\"\nincidence = \"20 deg\"\n"
      "at_least = \"1 %\"\n");
  CHECK(share.at_least.value() == doctest::Approx(0.01));
  CHECK(share.incidence_rad == doctest::Approx(20.0 * kDegree));
  check_contains(
      complaint_of([] { criterion_on_surface("quantity = \"mean_slope\"\nat_least = \"17 deg\"\n"); }),
      "surface");
  check_contains(complaint_of([] {
                   criterion_on_surface(
                       "quantity = \"lobe_width\"\nsurface = \"a\"\noutside = \"b\"\nincidence = \"45 deg\"\n"
                       "at_most = 3\n");
                 }),
                 "at_most");
}
