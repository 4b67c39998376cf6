// Results as JSON.
#include "scintray/report/text/result_json.hpp"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "analysis/made_up_events.hpp"
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
