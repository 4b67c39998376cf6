// [[bench]] and claims about its surfaces: what is read, and what is said of mistakes.
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

const std::string kPlainBench = R"([[bench]]
surfaces = ["polished", "ground"]
inside = "LSO"
outside = ["air"]
wavelength = "420 nm"
)";

std::vector<BenchSpec> benches_of(const std::string& text) {
  Problems problems;
  const TomlTable root(parse_toml(text, "scene.toml"), problems);
  std::vector<BenchSpec> benches = read_benches(root);
  root.finish();
  problems.throw_if_any();
  return benches;
}

std::string said_of_bench(const std::string& more) {
  return complaint_of([&] { benches_of(kPlainBench + more); });
}

ClaimSpec claim_on_surface(const std::string& body) {
  return claims_of_text("[[claim]]\ntext = \"what is said\"\n" + body, "scene.toml").at(0);
}

}  // namespace

TEST_CASE("A bench without anything optional reads from normal to grazing incidence") {
  const BenchSpec bench = benches_of(kPlainBench).at(0);
  REQUIRE(bench.surfaces.size() == 2);
  CHECK(bench.surfaces[1].name == "ground");
  CHECK(bench.surfaces[1].where.line == 2);
  CHECK(bench.inside.name == "LSO");
  CHECK(bench.outside.at(0).name == "air");
  CHECK(bench.wavelength_nm == 420.0);
  CHECK(bench.rays == 100'000);
  CHECK(bench.directions_at_rad == doctest::Approx(45.0 * kDegree));
  REQUIRE(bench.incidence_rad.size() == 37);
  CHECK(bench.incidence_rad.front() == 0.0);
  CHECK(bench.incidence_rad[18] == doctest::Approx(45.0 * kDegree));
  CHECK(bench.incidence_rad.back() == doctest::Approx(88.5 * kDegree));
}

TEST_CASE("Mistakes in a bench are told with their place") {
  check_says(said_of_bench("incidence = [\"40 deg\", \"20 deg\"]\n"), "scene.toml:6:");
  check_says(said_of_bench("incidence = [\"40 deg\", \"20 deg\"]\n"), "angles of incidence rise");
  check_says(said_of_bench("incidence = [\"90 deg\"]\n"), "below 90 deg");
  check_says(said_of_bench("directions_at = \"-1 deg\"\n"), "below 90 deg");
  check_says(said_of_bench("rays = 10\n"), "1,000 to 100,000,000");
  check_says(said_of_bench("ray = 10\n"), "rays");
  check_says(complaint_of([] { benches_of("[[bench]]\nsurfaces = [\"polished\"]\n"); }), "inside");
}

TEST_CASE("Claims about surfaces have bounds in the unit of their quantity") {
  const ClaimSpec slope = claim_on_surface(
      "quantity = \"mean_slope\"\nsurface = \"ground\"\noutside = \"air\"\nincidence = \"0 deg\"\n"
      "at_least = \"17 deg\"\n");
  CHECK(is_of_surface(slope.quantity));
  CHECK(slope.at_least.value() == doctest::Approx(17.0 * kDegree));
  const ClaimSpec share = claim_on_surface(
      "quantity = \"over_fresnel\"\nsurface = \"ground\"\noutside = \"air\"\nincidence = \"20 deg\"\n"
      "at_least = \"1 %\"\n");
  CHECK(share.at_least.value() == doctest::Approx(0.01));
  CHECK(share.incidence_rad == doctest::Approx(20.0 * kDegree));
  check_says(complaint_of([] { claim_on_surface("quantity = \"mean_slope\"\nat_least = \"17 deg\"\n"); }),
             "surface");
  check_says(complaint_of([] {
               claim_on_surface(
                   "quantity = \"lobe_width\"\nsurface = \"a\"\noutside = \"b\"\nincidence = \"45 deg\"\n"
                   "at_most = 3\n");
             }),
             "at_most");
}
