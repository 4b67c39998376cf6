// Reports of the benchmark: statistics, JSON, and the comparison with a baseline.

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "report_json.hpp"
#include "report_text.hpp"
#include "scintray/core/error.hpp"

using namespace scintray;
using namespace scintray::bench;
using nlohmann::json;

namespace {

/// A report of one scene, all of whose optional figures are there, and of one that has none of them.
Report made_up_report(double segments_per_s) {
  const auto about = [](double value) { return spread_of({0.9 * value, value, 1.1 * value}); };
  RunFigures one;
  one.segments_per_s = about(segments_per_s);
  one.photons_per_s = about(segments_per_s / 10);
  one.processor_share = about(1.0);
  RunFigures two = one;
  two.threads = 2;
  two.speedup = about(1.9);
  two.cpu_cost = about(1.05);
  two.events_per_s = about(20.0);
  SceneFigures full;
  full.name = "full";
  RunFigures lanes = one;
  lanes.asked_lane_width = lanes.lane_width = 4;
  lanes.segments_per_s = about(3.0 * segments_per_s);
  lanes.lane_gain = about(3.0);
  one.asked_lane_width = two.asked_lane_width = 1;
  full.runs = {one, two, lanes};
  full.segments_per_photon = 10.0;
  full.raw_embree_rays_per_s = about(2e7);
  full.segments_per_raw_ray = about(0.5);
  full.relative = RelativeFigures{"plain", about(0.4)};
  WorkShares work;
  work.samples = 1000;
  work.lines = true;
  work.shares[static_cast<std::size_t>(WorkKind::ray_query)] = 0.75;
  work.shares[static_cast<std::size_t>(WorkKind::other)] = 0.25;
  full.work = work;
  SceneFigures plain;
  plain.name = "plain";
  plain.runs = {one};
  Report report;
  report.version = "0.1.0";
  report.machine.cpu = "a processor";
  report.scenes = {full, plain};
  return report;
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("The spread of measurements is their median and quartiles, linear between them") {
  const Spread five = spread_of({5.0, 1.0, 4.0, 2.0, 3.0});
  CHECK(five.median == 3.0);
  CHECK(five.low == 2.0);
  CHECK(five.high == 4.0);
  CHECK(five.values.front() == 5.0);
  CHECK(five.relative() == doctest::Approx(1.0 / 3.0));
  CHECK(spread_of({2.0, 4.0}).median == 3.0);
  CHECK(spread_of({7.0}).relative() == 0.0);
  CHECK_THROWS_AS(spread_of({}), core::InternalError);
}

TEST_CASE("Paired ratios are made within rounds, so that a slower round for both changes nothing") {
  const std::vector<double> mine{10.0, 1.0, 20.0}, others{5.0, 0.5, 10.0};
  const Spread ratio = paired_ratio(mine, others);
  CHECK(ratio.median == 2.0);
  CHECK(ratio.relative() == 0.0);
  CHECK_THROWS_AS(paired_ratio(mine, std::vector<double>{1.0}), core::InternalError);
}

TEST_CASE("The JSON of a report has the documented keys") {
  const json node = json::parse(json_of(made_up_report(1e6)));
  for (const char* key :
       {"format", "format_version", "version", "date", "machine", "seconds", "rounds", "scenes"})
    CHECK_MESSAGE(node.contains(key), key);
  for (const char* key : {"cpu", "cores", "load_average", "system", "compiler", "flags", "embree"})
    CHECK_MESSAGE(node.at("machine").contains(key), key);
  const json& scene = node.at("scenes").at(0);
  for (const char* key : {"name", "shows", "regions", "triangles", "build_s", "build_MB", "photons", "events",
                          "lost", "segments_per_photon", "recorded_rays", "runs", "raw_embree_rays_per_s",
                          "segments_per_raw_ray", "relative", "work"})
    CHECK_MESSAGE(scene.contains(key), key);
  const json& run = scene.at("runs").at(1);
  for (const char* key : {"lane_width", "threads", "segments_per_s", "photons_per_s", "events_per_s",
                          "processor_share", "speedup", "cpu_cost"})
    CHECK_MESSAGE(run.contains(key), key);
  for (const char* key : {"median", "low", "high", "values"})
    CHECK_MESSAGE(run.at("segments_per_s").contains(key), key);
  for (const char* key : {"asked_lane_width", "lane_gain"})
    CHECK_MESSAGE(scene.at("runs").at(2).contains(key), key);
  CHECK(scene.at("work").at("by").get<std::string>() == "line");
  for (const auto& kind : kWorkKinds)
    CHECK_MESSAGE(scene.at("work").at("shares").contains(kind.word), kind.word);
  CHECK(scene.at("work").at("shares").at("ray query").get<double>() == 0.75);
  // A scene has no keys for what was not measured.
  CHECK_FALSE(node.at("scenes").at(1).contains("work"));
  CHECK_FALSE(node.at("scenes").at(1).at("runs").at(0).contains("speedup"));
}

TEST_CASE("Speed by lane width has columns of its own where several widths were asked for") {
  Report report = made_up_report(1e6);
  const std::string text = text_of_figures(report, nullptr);
  CHECK(has(text, "1 l: Mseg/s"));
  CHECK(has(text, "4 l: Mseg/s"));
  CHECK(has(text, "4 l / 1 l"));
  CHECK(has(text, "3.00 5%"));
  report.scenes.front().runs.pop_back();
  CHECK_FALSE(has(text_of_figures(report, nullptr), "1 l: Mseg/s"));
}

TEST_CASE("A note stands in the text and in the JSON of a report") {
  Report report = made_up_report(1e6);
  CHECK_FALSE(json::parse(json_of(report)).contains("note"));
  report.note = "a shared machine";
  CHECK(report_of_json(json_of(report), "report.json").note == report.note);
  CHECK(has(text_of_machine(report), report.note));
}

TEST_CASE("A report read from its JSON is the one that was written") {
  const std::string text = json_of(made_up_report(1e6));
  CHECK(json_of(report_of_json(text, "report.json")) == text);
}

TEST_CASE("What is no report is refused by its name") {
  for (const std::string text : {"", "{}", "[1]", R"({"format": "scintray benchmark", "format_version": 1})",
                                 R"({"format": "scintray benchmark", "format_version": 99})"}) {
    CAPTURE(text);
    try {
      report_of_json(text, "report.json");
      FAIL("no error");
    } catch (const core::InputError& error) {
      CHECK(error.problems().front().where.file == "report.json");
    }
  }
  CHECK_THROWS_AS(load_report("/nowhere/report.json"), core::InputError);
}

TEST_CASE("The ratio to a baseline is that of the medians, where both have one") {
  CHECK(ratio_to_baseline(spread_of({3.0}), spread_of({2.0})) == 1.5);
  CHECK_FALSE(ratio_to_baseline(std::nullopt, spread_of({2.0})).has_value());
  CHECK_FALSE(ratio_to_baseline(spread_of({3.0}), std::nullopt).has_value());
  CHECK_FALSE(ratio_to_baseline(spread_of({3.0}), spread_of({0.0})).has_value());
}

TEST_CASE("Tables print ratios beside the figures of scenes that the baseline has, and no others") {
  const Report now = made_up_report(3e6);
  Report before = made_up_report(2e6);
  CHECK(has(text_of_figures(now, &before), "(x 1.50)"));
  CHECK_FALSE(has(text_of_figures(now, nullptr), "(x "));
  for (SceneFigures& scene : before.scenes) scene.name += "_before";
  CHECK_FALSE(has(text_of_figures(now, &before), "(x "));
}

TEST_CASE("A baseline of another machine is pointed out") {
  const Report now = made_up_report(1e6);
  Report before = now;
  CHECK(text_of_differences(now, before).empty());
  before.machine.cpu = "another processor";
  CHECK(has(text_of_differences(now, before), "another processor"));
}
