// Claims of a scene against made-up runs.
#include "scintray/report/claims.hpp"

#include <doctest/doctest.h>

#include "scintray/report/html_report.hpp"
#include "scintray/report/text_summary.hpp"
#include "support/made_up_result.hpp"
#include "support/words.hpp"

using namespace scintray;
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

double light(const RunResult& run, std::size_t point) {
  return run.points[point].fraction(Fate::detected).value;
}

}  // namespace

TEST_CASE("The quantities of claims are those of the curves") {
  const RunResult run = made_up_run();  // polished 0 to 4, ground table 5 to 9, UNIFIED 10 to 14
  const auto ours = [&](const ClaimSpec& spec) { return judge(run, {}, {spec}).at(0).ours.value; };
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
  const Estimate measured = judge(run, {}, {spec}).at(0).ours;
  REQUIRE(measured.error > 0.0);
  const auto verdict = [&](double at_least) {
    spec.at_most.reset();
    spec.at_least = at_least;
    return judge(run, {}, {spec}).at(0);
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
  check_says(complaint_of([&] { check_curves(one, {"polished", {}}, {}); }), "no sweep over a number");
}
