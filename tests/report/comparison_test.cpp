// Several results, number by number.
#include "scintray/report/pages/pages.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/made_up_events.hpp"
#include "support/made_up_result.hpp"
#include "support/page_scripts.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::tally;
using namespace scintray::report;
using namespace scintray::test;
using doctest::Approx;

namespace {

NamedResult named(const std::string& name, std::uint64_t seed, double light) {
  NamedResult result{name, made_up_run(), {}};
  result.run.points = {made_up_point({"polished", "2 mm"}, light, 100'000),
                       made_up_point({"polished", "6 mm"}, 0.40, 100'000)};
  result.run.header.seed = seed;
  return result;
}

const ComparedNumber& detected(const std::vector<ComparedNumber>& numbers, const std::string& point) {
  const auto found = std::find_if(numbers.begin(), numbers.end(), [&](const ComparedNumber& number) {
    return number.point == point && number.quantity.rfind("detected", 0) == 0;
  });
  REQUIRE(found != numbers.end());
  return *found;
}

}  // namespace

TEST_CASE("A comparison as JSON has the numbers of its table, and what makes them unfair") {
  const std::vector<NamedResult> results{named("a", 1, 0.45), named("b", 1, 0.46)};
  const auto json = nlohmann::json::parse(comparison_json(results));
  const std::vector<ComparedNumber> numbers = compare_results(results);
  CHECK(json["results"][1]["name"] == "b");
  REQUIRE(json["numbers"].size() == numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    CHECK(json["numbers"][i]["point"] == numbers[i].point);
    CHECK(json["numbers"][i]["quantity"] == numbers[i].quantity);
    CHECK(json["numbers"][i]["values"][1]["value"] == numbers[i].values[1]->value);
    CHECK(json["numbers"][i]["sigmas"][0].is_null());
    if (numbers[i].sigmas[1]) CHECK(json["numbers"][i]["sigmas"][1] == *numbers[i].sigmas[1]);
  }
  CHECK(json["cautions"].size() == 1);  // one seed
  CHECK(json["not_included"].size() == 1);
}

TEST_CASE("Differences are in standard errors of the difference, point by point") {
  NamedResult other = named("b", 2, 0.46);
  std::swap(other.run.points[0], other.run.points[1]);  // matched by their values, not by their order
  const std::vector<NamedResult> results{named("a", 1, 0.45), other};
  const std::vector<ComparedNumber> numbers = compare_results(results);
  const ComparedNumber& first = detected(numbers, "polished, 2 mm");
  const Estimate a = results[0].run.points[0].fraction(Fate::detected),
                 b = results[1].run.points[1].fraction(Fate::detected);
  CHECK_FALSE(first.sigmas[0]);
  REQUIRE(first.sigmas[1]);
  CHECK(*first.sigmas[1] == Approx((b.value - a.value) / std::hypot(a.error, b.error)));
  CHECK(*detected(numbers, "polished, 6 mm").sigmas[1] == 0.0);
  const std::string text = comparison_text(results);
  check_contains(text, {"polished, 2 mm", "detected", "+4.5"});
  check_contains(text, {"the largest 5.7 sigma", "absorbed at surface"});
  CHECK_FALSE(contains(text, "has the seed"));
}

TEST_CASE("A point or a number that a result lacks is none, and equal seeds and partial results are said") {
  NamedResult short_one = named("short", 1, 0.45);
  short_one.run.points.resize(1);
  short_one.run.partial_reason = "interrupted";
  const std::vector<NamedResult> results{named("a", 1, 0.45), named("c", 3, 0.45), short_one};
  const ComparedNumber lacking = detected(compare_results(results), "polished, 6 mm");
  CHECK(lacking.values[1]);
  CHECK_FALSE(lacking.values[2]);
  CHECK_FALSE(lacking.sigmas[2]);
  const std::string page = comparison_page(results);
  check_contains(page, "short has the seed of a result before it");
  check_contains(page, "short is partial: interrupted");
  check_contains(page, "<td class=\"n\">none</td>");
  CHECK_FALSE(contains(scripts_of(page).page, "nan"));
}

TEST_CASE("Results of one point each are compared whatever was swept") {
  NamedResult a = named("a", 1, 0.45), b = named("b", 2, 0.46);
  a.run.points.resize(1);
  b.run.points.resize(1);
  b.run.points[0].parameters = {"ground", "9 mm"};
  CHECK(detected(compare_results({a, b}), "polished, 2 mm").sigmas[1]);
}

TEST_CASE("What detected fractions, resolutions and CTRs do not include stands beside a comparison of them") {
  const MadeUpDetector detector;
  const auto with_events = [&](const std::string& name, std::uint64_t seed) {
    NamedResult result = named(name, seed, 0.45);
    result.run.points.resize(1);
    result.run.points[0].omitted =
        std::vector<OmittedEffect>{{"non-proportionality", "LSO", "", true, false, false},
                                   {"electronic noise", "", "[readout] noise", true, true, false},
                                   {"reflection behind the window", "pmt", "", false, false, true}};
    result.analyses.points = {analysis::analyze_events(detector.events(3000, true), detector.setup())};
    return result;
  };
  std::vector<NamedResult> results{with_events("a", 1), with_events("b", 2)};
  const std::vector<std::string> sentences{
      "The detected fraction does not include: reflection behind the window (pmt).",
      "The energy resolution does not include: non-proportionality (LSO); electronic noise.",
      "The CTR does not include: electronic noise."};
  for (const std::string& text : {comparison_text(results), comparison_page(results)}) {
    for (const std::string& sentence : sentences) check_contains(text, sentence);
    CHECK_FALSE(contains(text, "a, b: The"));
  }
  // Results that leave out something else are named; of a result without a figure nothing is stated.
  results[1].run.points[0].omitted->pop_back();
  results.push_back(named("photons", 3, 0.45));
  results[2].run.points.resize(1);
  for (const std::string& text : {comparison_text(results), comparison_page(results)}) {
    check_contains(text, "a: " + sentences[0]);
    check_contains(text, "b: The detected fraction includes every effect that is modelled.");
    check_contains(text, "photons: What the detected fraction does not include is not recorded");
    CHECK_FALSE(contains(text, "a, b: The"));
    CHECK_FALSE(contains(text, "What the CTR does not include"));
  }
}
