// Claims of a scene against made-up runs.
#include "scintray/report/acceptance.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "scintray/optics/fresnel.hpp"
#include "scintray/report/pages/html_report.hpp"
#include "scintray/report/surface_acceptance.hpp"
#include "scintray/report/text/text_summary.hpp"
#include "support/made_up_result.hpp"
#include "support/made_up_surface.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::scene_file;
using namespace scintray::tally;
using namespace scintray::analysis;
using namespace scintray::report;
using namespace scintray::report;
using namespace scintray::test;

namespace {

ClaimSpec claim(ClaimQuantity quantity, const std::string& curve, const std::string& over = "") {
  ClaimSpec spec;
  spec.text = "what is said";
  spec.quantity = quantity;
  spec.curve = {curve, {}};
  spec.over = {over, {}};
  spec.at_most = 0.05;
  return spec;
}

Verdict judged(const RunResult& run, const ClaimSpec& spec) {
  RunStudies studies;
  studies.claims = {spec};
  return judge(run, studies).at(0);
}

double light(const RunResult& run, std::size_t point) {
  return run.points[point].fraction(Fate::detected).value;
}

}  // namespace

TEST_CASE("The quantities of claims are those of the curves") {
  const RunResult run = made_up_run();  // polished 0 to 4, ground table 5 to 9, UNIFIED 10 to 14
  const auto ours = [&](const ClaimSpec& spec) { return judged(run, spec).ours.value; };
  const double fall_polished = 1.0 - light(run, 4) / light(run, 0);
  const double fall_table = 1.0 - light(run, 9) / light(run, 5);
  CHECK(ours(claim(ClaimQuantity::fall, "polished")) == doctest::Approx(fall_polished));
  CHECK(ours(claim(ClaimQuantity::fall_difference, "ground, table", "polished")) ==
        doctest::Approx(fall_table - fall_polished));
  CHECK(ours(claim(ClaimQuantity::light, "ground, table")) == doctest::Approx(light(run, 5)));
  CHECK(ours(claim(ClaimQuantity::maximum_ratio, "ground, UNIFIED", "ground, table")) ==
        doctest::Approx(light(run, 10) / light(run, 5)));
  double mean = 0.0;
  for (std::size_t i = 0; i < 5; ++i) mean += light(run, i) / 5.0;
  CHECK(ours(claim(ClaimQuantity::range, "polished")) ==
        doctest::Approx((light(run, 0) - light(run, 4)) / mean));
  CHECK(ours(claim(ClaimQuantity::time_ratio, "polished", "ground, table")) == doctest::Approx(1.0));
}

TEST_CASE("A verdict says whether the number lies within the bounds, and how surely") {
  const RunResult run = made_up_run();
  ClaimSpec spec = claim(ClaimQuantity::light, "polished");
  const Estimate measured = judged(run, spec).ours;
  REQUIRE(measured.error > 0.0);
  const auto verdict = [&](double at_least) {
    spec.at_most.reset();
    spec.at_least = at_least;
    return judged(run, spec);
  };
  CHECK(verdict(measured.value - 5.0 * measured.error).agrees);
  CHECK(verdict(measured.value - 5.0 * measured.error).certain);
  CHECK(verdict(measured.value - measured.error).agrees);
  CHECK_FALSE(verdict(measured.value - measured.error).certain);
  CHECK_FALSE(verdict(measured.value + measured.error).agrees);
  CHECK_FALSE(verdict(measured.value + measured.error).certain);
  CHECK(verdict(measured.value + 5.0 * measured.error).certain);
}

TEST_CASE("Claims stand on the page and in the summary; what cannot be told says why") {
  const RunResult run = made_up_run();
  RunStudies studies;
  studies.claims = {claim(ClaimQuantity::fall, "polished"), claim(ClaimQuantity::fall, "ground, table"),
                    claim(ClaimQuantity::resolution, "polished")};
  const std::string text = text_summary(run, studies);
  check_says(text, "agrees   what is said [polished]");
  check_says(text, "DIFFERS  what is said [ground, table]");
  check_says(text, "NOT TOLD what is said [polished]: a run of photons has no photopeak");
  check_says(html_report(run, studies), "What was expected");
}

TEST_CASE("Curves that a run does not have are named with those that it has") {
  const RunResult run = made_up_run();
  const std::string said = complaint_of([&] {
    check_curves(run, {"pollished", {}}, {claim(ClaimQuantity::fall, "ground")});
  });
  check_says(said, "did you mean \"polished\"?");
  check_says(said, "\"ground\"");
  RunResult one = run;
  one.points.resize(1);
  check_says(complaint_of([&] { check_curves(one, {"polished", {}}, {}); }), {"no sweep", "number"});
}

namespace {

ClaimSpec surface_claim(ClaimQuantity quantity, const std::string& surface, double incidence_deg) {
  ClaimSpec spec = claim(quantity, "");
  spec.surface = {surface, {"scene.toml", 7, 1}};
  spec.outside = {"air", {"scene.toml", 8, 1}};
  spec.incidence_rad = incidence_deg * kDegree;
  return spec;
}

}  // namespace

TEST_CASE("Claims about surfaces take their numbers from the bench") {
  const std::vector<SurfaceStudy> studies{made_up_surface("polished", "grease"),
                                          made_up_surface("ground", "air")};
  const auto ours = [&](ClaimQuantity quantity, double incidence_deg) {
    return surface_value(surface_claim(quantity, "ground", incidence_deg), studies);
  };
  CHECK(ours(ClaimQuantity::mean_slope, 20.0).value == doctest::Approx(19.0 * kDegree));
  CHECK(ours(ClaimQuantity::mean_slope, 20.0).error == doctest::Approx(0.2 * kDegree));
  CHECK(ours(ClaimQuantity::reflectance, 45.0).value == 0.8);
  CHECK(ours(ClaimQuantity::over_fresnel, 20.0).value ==
        doctest::Approx(0.33 - fresnel(std::cos(20.0 * kDegree), 1.82, 1.0).unpolarised()));
  CHECK(ours(ClaimQuantity::lobe_width, 45.0).value == doctest::Approx(30.0 * kDegree));
}

TEST_CASE("Claims about surfaces stand on the page with their figures") {
  RunStudies studies;
  studies.surfaces = {made_up_surface("ground", "air")};
  studies.claims = {surface_claim(ClaimQuantity::mean_slope, "ground", 0.0)};
  studies.claims[0].at_most.reset();
  studies.claims[0].at_least = 17.0 * kDegree;
  const RunResult run = made_up_run();
  check_says(
      text_summary(run, studies),
      "agrees   what is said [ground to air at 0 deg]: 18.00 \u00b1 0.10 deg (expected at least 17 deg)");
  const std::string page = html_report(run, studies);
  check_says(page, "Faces");
  check_says(page, "mean slope met (deg)");
  check_says(page, "Fresnel, flat");
  check_says(page, "Directions of reflected light at 45 deg");
}

TEST_CASE("Claims about surfaces that no bench reads are refused before the run") {
  BenchSpec bench;
  bench.surfaces = {{"ground", {}}};
  bench.outside = {{"air", {}}};
  bench.incidence_rad = {0.0};
  bench.directions_at_rad = 45.0 * kDegree;
  const auto said = [&](const ClaimSpec& spec, bool with_bench = true) {
    return complaint_of(
        [&] { check_surface_claims(with_bench ? std::vector{bench} : std::vector<BenchSpec>{}, {spec}); });
  };
  CHECK(said(surface_claim(ClaimQuantity::mean_slope, "ground", 0.0)).empty());
  CHECK(said(surface_claim(ClaimQuantity::lobe_width, "ground", 45.0)).empty());
  check_says(said(surface_claim(ClaimQuantity::mean_slope, "grounnd", 0.0)), "did you mean \"ground\"?");
  check_says(said(surface_claim(ClaimQuantity::mean_slope, "grounnd", 0.0)), "scene.toml:7");
  check_says(said(surface_claim(ClaimQuantity::reflectance, "ground", 45.0)), "at 45 deg");
  check_says(said(surface_claim(ClaimQuantity::lobe_width, "ground", 0.0)), "directions_at");
  check_says(said(surface_claim(ClaimQuantity::mean_slope, "ground", 0.0), false), "no [[bench]]");
}
