// Results as JSON.
#include "scintray/report/text/result_json.hpp"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "analysis/made_up_events.hpp"
#include "scintray/analysis/light_analysis.hpp"
#include "scintray/report/acceptance.hpp"
#include "scintray/report/text/text_summary.hpp"
#include "scintray/report/text/until_text.hpp"
#include "support/made_up_result.hpp"

using namespace scintray;
using namespace scintray::analysis;
using namespace scintray::core;
using namespace scintray::tally;
using nlohmann::json;

TEST_CASE("JSON has the fates of every point and what they do not include") {
  RunResult run = test::made_up_run();
  run.points[0].omitted =
      std::vector<OmittedEffect>{{"reflection behind the window", "pmt", "", false, false, true},
                                 {"noise", "", "[readout]", true, true, false}};
  const json result = json::parse(report::result_json(run, {}));
  CHECK(result["points"].size() == run.points.size());
  CHECK(result["seed"] == run.header.seed);
  const json& first = result["points"][0];
  CHECK(first["parameters"]["source.region.slab_z.center"] == "2 mm");
  CHECK(first["fates"]["detected"]["photons"] == run.points[0].count(Fate::detected));
  CHECK(first["fates"]["detected"]["error"] == run.points[0].fraction(Fate::detected).error);
  CHECK(first["not_included"][0]["effect"] == "reflection behind the window");
  CHECK(first["not_included"][0]["changes"] == json::array({"detected fraction"}));
  CHECK(first["not_included"][1]["changes"] == json::array({"energy resolution", "CTR"}));
  CHECK(result["points"][1]["not_included"].is_null());  // not recorded
}

TEST_CASE("JSON has absorbed light, means, tallies with their errors, and what follows from them") {
  RunResult run = test::made_up_run();
  run.points.resize(1);
  PointResult& point = run.points[0];
  TallyResult spread;
  spread.name = "arrival";
  spread.type = "light_spread";
  spread.score = "photons";
  spread.unit = "1";
  spread.axes.resize(2);
  for (TallyAxis& axis : spread.axes) axis = {"position", "mm", {0.0, 1.0, 2.0}, {}, {}};
  spread.sum = spread.sum_of_squares = {1.0, 0.0, 3.0, 4.0};
  spread.outside = 2.0;
  point.tallies.push_back(spread);
  const json first = json::parse(report::result_json(run, {}))["points"][0];
  CHECK(first["absorbed_in_medium"]["LSO"]["photons"] == point.absorbed_in_medium[MediumId(0)]);
  CHECK(first["absorbed_in_medium"]["LSO"]["error"] == point.absorbed_fraction(MediumId(0)).error);
  CHECK(first["absorbed_at_surface"]["reflector: ESR"]["fraction"] ==
        point.absorbed_fraction(SurfaceId(1)).value);
  CHECK(first["detected_path_mm"]["value"] == point.detected_path_mm.mean().value);
  CHECK(first["detected_time_ns"]["error"] == point.detected_time_ns.mean().error);
  CHECK(first["tallies"].size() == 1);  // exit angles have their own
  const json& tally = first["tallies"].back();
  CHECK(tally["name"] == "arrival");
  CHECK(tally["axes"][1]["edges"] == json::array({0.0, 1.0, 2.0}));
  CHECK(tally["sum"] == json::array({1.0, 0.0, 3.0, 4.0}));
  CHECK(tally["error"][3] == spread.at(3, point.photons).error);
  CHECK(tally["outside"] == 2.0);
  // Lists of numbers on one line each: a tally of a million bins has two lines of them.
  CHECK(report::result_json(run, {}).find("\"sum\": [1.0,0.0,3.0,4.0]") != std::string::npos);
  point.tallies.back().sum = {0.0, 0.0, 0.0, 0.0};
  CHECK_FALSE(json::parse(report::result_json(run, {}))["points"][0]["tallies"][0].contains("light_spread"));
  CHECK(tally["light_spread"]["centre_mm"][0] == analysis::light_spread(spread).centre_mm[0]);
  CHECK(tally["light_spread"]["centre_mm"][0].get<double>() == doctest::Approx(1.375));  // 7 of 8 at 1.5 mm
  REQUIRE(first["exit_angles"].size() == 2);
  const analysis::CrossingAngles angles = analysis::crossing_angles(point).front();
  CHECK(first["exit_angles"][0]["face"] == "crystal:exit");
  CHECK(first["exit_angles"][0]["outside"]["counts"] == angles.outside);
  CHECK(first["exit_angles"][0]["inside"]["half_rad"]["value"] ==
        analysis::divergence(angles.inside).half_rad.value);
}

TEST_CASE("JSON has the claims of a scene, with their values, errors and limits") {
  const RunResult run = test::made_up_run();
  report::RunAnalysis analyses;
  scene_file::CriterionSpec claim;
  claim.text = "polished loses little light";
  claim.published = "0.98";
  claim.quantity = scene_file::CriterionQuantity::light;
  claim.curve.name = "polished";
  claim.at_least = 0.9;
  analyses.criteria.push_back(claim);
  const json claims = json::parse(report::result_json(run, analyses))["claims"];
  REQUIRE(claims.size() == 1);
  const std::vector<report::Evaluation> evaluations = report::evaluate(run, analyses);
  CHECK(claims[0]["claim"] == claim.text);
  CHECK(claims[0]["at_least"] == 0.9);
  CHECK(claims[0]["at_most"].is_null());
  REQUIRE(evaluations[0].not_available.empty());
  CHECK(claims[0]["value"] == evaluations[0].ours.value);
  CHECK(claims[0]["error"] == evaluations[0].ours.error);
  CHECK(claims[0]["agrees"] == evaluations[0].agrees);
  CHECK_FALSE(json::parse(report::result_json(run, {})).contains("claims"));
}

TEST_CASE("JSON and the summary state what ended a point") {
  RunResult run = test::made_up_run();
  run.points.resize(1);
  run.points[0].until.emplace().conditions = {{"relative_error", 0.01, 0.0098, true},
                                              {"wall_time", 60.0, 12.0, false}};
  const json until = json::parse(report::result_json(run, {}))["points"][0]["until"];
  CHECK(until["ended"] == true);
  CHECK(until["reproducible"] == true);
  CHECK(until["conditions"][0]["condition"] == "relative_error");
  CHECK(until["conditions"][0]["reached"] == 0.0098);
  CHECK(until["conditions"][1]["met"] == false);
  CHECK(report::until_sentence(run.points[0]).find("0.0098, goal 0.01") != std::string::npos);
  CHECK(report::text_summary(run, {}).find(report::until_sentence(run.points[0])) != std::string::npos);
  run.points[0].until->conditions[0].met = false;
  run.points[0].until->conditions[1].met = true;
  CHECK(report::until_sentence(run.points[0]).find("another run") != std::string::npos);
  run.points[0].until->conditions[1].met = false;
  CHECK(report::until_sentence(run.points[0]).find("before a condition") != std::string::npos);
}

TEST_CASE("JSON has every number of the analysis of events") {
  const test::MadeUpDetector detector;
  RunResult run = test::made_up_run();
  run.points.resize(1);
  report::RunAnalysis analyses;
  analyses.points.push_back(analyze_events(detector.events(6000, true), detector.setup()));
  const EventAnalysis& analysis = analyses.points.front();
  const json fields = json::parse(report::result_json(run, analyses))["points"][0]["analysis"];
  CHECK(fields["pulses"] == analysis.pulses);
  CHECK(fields["photopeak"]["status"] == "trusted");
  CHECK(fields["photopeak"]["resolution_fwhm"] == analysis.peak.fit.relative_fwhm.value);
  CHECK(fields["photopeak"]["resolution_fwhm_error"] == analysis.peak.fit.relative_fwhm.error);
  CHECK(fields["spectrum"]["edges"].size() == fields["spectrum"]["bin_counts"].size() + 1);
  CHECK(fields["depth_of_interaction"]["residual"]["quantile_fwhm"] ==
        analysis.doi->residual.quantile_fwhm.value);
  CHECK(fields["flood_map"]["peaks"]["x_mm"].size() == 16);
  CHECK(fields["flood_map"]["map"]["cell_events"].size() == analysis.flood->grid.counts.size());
  CHECK(fields["parts"]["pulses"].size() == 16);
  CHECK(fields["coincidence"]["quantile_fwhm"] == analysis.pair_difference_ns->quantile_fwhm.value);
  CHECK(fields["timing_against_depth"]["depth_mm"].size() == 10);
  CHECK(fields["left_out"].empty());
}
