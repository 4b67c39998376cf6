// The page of events.
#include "scintray/report/pages/event_section.hpp"

#include <doctest/doctest.h>

#include <cstdlib>
#include <fstream>

#include "analysis/made_up_events.hpp"
#include "scintray/report/text/format.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::tally;
using namespace scintray::analysis;
using namespace scintray::report;
using namespace scintray::test;

namespace {

report::PointStudy made_up_study(const std::string& label, std::size_t events, bool readout) {
  const MadeUpDetector detector;
  return {label, study_events(detector.events(events, readout), detector.setup())};
}

}  // namespace

TEST_CASE("The page of events holds the numbers of every study and loads nothing") {
  const report::PointStudy point = made_up_study("rough", 6000, true);
  const std::string page = report::event_page("Dual-ended array", "results.h5", {point});
  const EventStudy& study = point.study;
  for (const std::string& words :
       {report::with_error(study.peak.fit.position), report::percent_with_error(study.peak.fit.relative_fwhm),
        report::with_error(study.doi->residual.quantile_fwhm), std::string("16 peaks for 16 parts"),
        std::string("coincidence of two such detectors"), std::string("timing against depth")})
    check_says(page, words);
  for (const char* outside : {"<script", "http:", "https:", "url(", "@import", "<link", "nan", "inf\""})
    CHECK_FALSE(contains(page, outside));
  if (const char* name = std::getenv("SCINTRAY_EVENT_PAGE")) std::ofstream(name) << page;
}

TEST_CASE("Lines for the terminal say the same") {
  const std::string lines = report::event_lines(made_up_study("run", 6000, true).study);
  check_says(lines, "pulses: 5");
  check_says(lines, "spectrum: photopeak");
  check_says(lines, "one FWHM of the photopeak");
  check_says(lines, {"depth of interaction:", "A / (A + B)", "monotone calibration", "FWHM"});
  check_says(lines, {"coincidence", "two", "FWHM"});
  CHECK_FALSE(contains(lines, "nan"));
}

TEST_CASE("A point of few events says what is missing, and labels are escaped") {
  const std::string page = report::event_page("t", "u", {made_up_study("<b>&", 40, false)});
  check_says(page, "&lt;b&gt;&amp;");
  CHECK_FALSE(contains(page, "<b>&"));
  check_says(page, "too few events");
  check_says(page, "What was left out");
  check_says(page, {"40 events", "flood map", "100"});
  CHECK(report::event_section({}).empty());
  CHECK(report::event_section({{"none", EventStudy{}}}).empty());
  CHECK(report::event_lines(EventStudy{}).empty());
}

TEST_CASE("Points of a sweep over depth become one curve") {
  const MadeUpDetector detector;
  std::vector<report::PointStudy> points;
  for (const float depth : {4.0F, 10.0F, 16.0F}) {
    std::vector<EventRecord> events = detector.events(1500, true);
    for (EventRecord& event : events) event.position_mm[2] = depth;
    points.push_back({std::to_string(depth), study_events(events, detector.setup())});
  }
  check_says(report::event_section(points), "all points: light against depth");
  points.push_back(made_up_study("all depths", 1500, true));
  CHECK_FALSE(contains(report::event_section(points), "all points"));
  points.pop_back();
  points[1].study.mean_depth_mm.reset();
  CHECK_FALSE(contains(report::event_section(points), "all points"));
}

TEST_CASE("Timing by order of photons is drawn with its best n, the bound, against depth and over points") {
  std::vector<std::vector<double>> events;
  for (std::size_t event = 0; event < 400; ++event) {
    Rng rng = toy_rng(70, event);
    events.push_back(sample_photon_times(200.0, 40.0, 0.1, 0.1, rng));
  }
  EventStudy study;
  study.events = study.pulses = 400;
  study.orders = study_orders(events, 10);
  const std::string plain = report::event_section({{"alone", study}});
  check_says(plain, "best single photon ");
  CHECK_FALSE(contains(plain, "bound"));
  CHECK_FALSE(contains(plain, "all points"));

  study.orders_bound = timing_bound({{{40.0, 0.1, 1.0}}, 0.1}, 200.0, study.orders->single);
  study.orders_against_depth = {{4.0, 200, 200.0, *study.orders}, {8.0, 200, 180.0, *study.orders}};
  study.depth_bounds = {study.orders_bound, std::nullopt};
  const std::string drawn = report::event_section({{"one", study}, {"two", study}});
  check_says(drawn, "bound by all 200 photons");
  check_says(drawn, "bound by the first n");
  check_says(drawn, "by order of photons against depth");
  check_says(drawn, "all points: coincidence of two such detectors by the n-th photon");
  const std::string lines = report::event_lines(study);
  check_says(lines, "CTR by the n-th photon: n = 1: ");
  check_says(lines, "best photon at each depth: 4 mm: photon ");
}
