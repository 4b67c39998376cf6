// Claims of a scene against made-up runs.
#include "scintray/report/acceptance.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "scintray/optics/fresnel.hpp"
#include "scintray/report/pages/pages.hpp"
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

CriterionSpec criterion(CriterionQuantity quantity, const std::string& curve, const std::string& over = "") {
  CriterionSpec spec;
  spec.text = "what is said";
  spec.quantity = quantity;
  spec.curve = {curve, {}};
  spec.over = {over, {}};
  spec.at_most = 0.05;
  return spec;
}

Evaluation evaluated(const RunResult& run, const CriterionSpec& spec) {
  RunAnalysis analyses;
  analyses.criteria = {spec};
  return evaluate(run, analyses).at(0);
}

double light(const RunResult& run, std::size_t point) {
  return run.points[point].fraction(Fate::detected).value;
}

}  // namespace

TEST_CASE("The quantities of acceptance criteria are those of the curves") {
  const RunResult run = made_up_run();  // polished 0 to 4, ground table 5 to 9, UNIFIED 10 to 14
  const auto ours = [&](const CriterionSpec& spec) { return evaluated(run, spec).ours.value; };
  const double fall_polished = 1.0 - light(run, 4) / light(run, 0);
  const double fall_table = 1.0 - light(run, 9) / light(run, 5);
  CHECK(ours(criterion(CriterionQuantity::fall, "polished")) == doctest::Approx(fall_polished));
  CHECK(ours(criterion(CriterionQuantity::fall_difference, "ground, table", "polished")) ==
        doctest::Approx(fall_table - fall_polished));
  CHECK(ours(criterion(CriterionQuantity::light, "ground, table")) == doctest::Approx(light(run, 5)));
  CHECK(ours(criterion(CriterionQuantity::maximum_ratio, "ground, UNIFIED", "ground, table")) ==
        doctest::Approx(light(run, 10) / light(run, 5)));
  double mean = 0.0;
  for (std::size_t i = 0; i < 5; ++i) mean += light(run, i) / 5.0;
  CHECK(ours(criterion(CriterionQuantity::range, "polished")) ==
        doctest::Approx((light(run, 0) - light(run, 4)) / mean));
  CHECK(ours(criterion(CriterionQuantity::time_ratio, "polished", "ground, table")) == doctest::Approx(1.0));
}

TEST_CASE("An evaluation has whether the number lies within the bounds, and how certainly") {
  const RunResult run = made_up_run();
  CriterionSpec spec = criterion(CriterionQuantity::light, "polished");
  const Estimate measured = evaluated(run, spec).ours;
  REQUIRE(measured.error > 0.0);
  const auto evaluation = [&](double at_least) {
    spec.at_most.reset();
    spec.at_least = at_least;
    return evaluated(run, spec);
  };
  CHECK(evaluation(measured.value - 5.0 * measured.error).agrees);
  CHECK(evaluation(measured.value - 5.0 * measured.error).certain);
  CHECK(evaluation(measured.value - measured.error).agrees);
  CHECK_FALSE(evaluation(measured.value - measured.error).certain);
  CHECK_FALSE(evaluation(measured.value + measured.error).agrees);
  CHECK_FALSE(evaluation(measured.value + measured.error).certain);
  CHECK(evaluation(measured.value + 5.0 * measured.error).certain);
}

TEST_CASE("Acceptance criteria are on the page and in the summary, or why a number is not available") {
  const RunResult run = made_up_run();
  RunAnalysis analyses;
  analyses.criteria = {criterion(CriterionQuantity::fall, "polished"),
                       criterion(CriterionQuantity::fall, "ground, table"),
                       criterion(CriterionQuantity::resolution, "polished")};
  const std::string text = text_summary(run, analyses);
  check_contains(text, "agrees   what is said [polished]");
  check_contains(text, "DIFFERS  what is said [ground, table]");
  check_contains(text, "NOT AVAILABLE what is said [polished]: a run of photons has no photopeak");
  check_contains(html_report(run, analyses), "What was expected");
}

TEST_CASE("Curves that a run does not have are named with those that it has") {
  const RunResult run = made_up_run();
  const std::string said = complaint_of([&] {
    check_curves(run, {"pollished", {}}, {criterion(CriterionQuantity::fall, "ground")});
  });
  check_contains(said, "did you mean \"polished\"?");
  check_contains(said, "\"ground\"");
  RunResult one = run;
  one.points.resize(1);
  check_contains(complaint_of([&] { check_curves(one, {"polished", {}}, {}); }), {"no sweep", "number"});
}

namespace {

CriterionSpec surface_criterion(CriterionQuantity quantity, const std::string& surface,
                                double incidence_deg) {
  CriterionSpec spec = criterion(quantity, "");
  spec.surface = {surface, {"scene.toml", 7, 1}};
  spec.outside = {"air", {"scene.toml", 8, 1}};
  spec.incidence_rad = incidence_deg * kDegree;
  return spec;
}

}  // namespace

TEST_CASE("Acceptance criteria about surfaces use the numbers of the goniometer") {
  const std::vector<SurfaceAnalysis> analyses{made_up_surface("polished", "grease"),
                                              made_up_surface("ground", "air")};
  const auto ours = [&](CriterionQuantity quantity, double incidence_deg) {
    return surface_value(surface_criterion(quantity, "ground", incidence_deg), analyses);
  };
  CHECK(ours(CriterionQuantity::mean_slope, 20.0).value == doctest::Approx(19.0 * kDegree));
  CHECK(ours(CriterionQuantity::mean_slope, 20.0).error == doctest::Approx(0.2 * kDegree));
  CHECK(ours(CriterionQuantity::reflectance, 45.0).value == 0.8);
  CHECK(ours(CriterionQuantity::over_fresnel, 20.0).value ==
        doctest::Approx(0.33 - fresnel(std::cos(20.0 * kDegree), 1.82, 1.0).unpolarised()));
  CHECK(ours(CriterionQuantity::lobe_width, 45.0).value == doctest::Approx(30.0 * kDegree));
}

TEST_CASE("Acceptance criteria about surfaces are on the page with their figures") {
  RunAnalysis analyses;
  analyses.surfaces = {made_up_surface("ground", "air")};
  analyses.criteria = {surface_criterion(CriterionQuantity::mean_slope, "ground", 0.0)};
  analyses.criteria[0].at_most.reset();
  analyses.criteria[0].at_least = 17.0 * kDegree;
  const RunResult run = made_up_run();
  check_contains(
      text_summary(run, analyses),
      "agrees   what is said [ground to air at 0 deg]: 18.00 \u00b1 0.10 deg (expected at least 17 deg)");
  const std::string page = html_report(run, analyses);
  check_contains(page, "Faces");
  check_contains(page, "mean visible slope (deg)");
  check_contains(page, "Fresnel, flat");
  check_contains(page, "Directions of reflected light at 45 deg");
}

TEST_CASE("Acceptance criteria about surfaces that no goniometer measures are refused before the run") {
  GoniometerSpec goniometer;
  goniometer.surfaces = {{"ground", {}}};
  goniometer.outside = {{"air", {}}};
  goniometer.incidence_rad = {0.0};
  goniometer.directions_at_rad = 45.0 * kDegree;
  const auto said = [&](const CriterionSpec& spec, bool with_goniometer = true) {
    return complaint_of([&] {
      check_surface_criteria(with_goniometer ? std::vector{goniometer} : std::vector<GoniometerSpec>{},
                             {spec});
    });
  };
  CHECK(said(surface_criterion(CriterionQuantity::mean_slope, "ground", 0.0)).empty());
  CHECK(said(surface_criterion(CriterionQuantity::lobe_width, "ground", 45.0)).empty());
  check_contains(said(surface_criterion(CriterionQuantity::mean_slope, "grounnd", 0.0)),
                 "did you mean \"ground\"?");
  check_contains(said(surface_criterion(CriterionQuantity::mean_slope, "grounnd", 0.0)), "scene.toml:7");
  check_contains(said(surface_criterion(CriterionQuantity::reflectance, "ground", 45.0)), "at 45 deg");
  check_contains(said(surface_criterion(CriterionQuantity::lobe_width, "ground", 0.0)), "directions_at");
  check_contains(said(surface_criterion(CriterionQuantity::mean_slope, "ground", 0.0), false),
                 "no [[bench]]");
}
