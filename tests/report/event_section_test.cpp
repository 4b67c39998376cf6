// The page of events.
#include "scintray/report/pages/event_section.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "analysis/made_up_events.hpp"
#include "scintray/report/text/format.hpp"
#include "support/page_scripts.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::tally;
using namespace scintray::analysis;
using namespace scintray::report;
using namespace scintray::test;

namespace {

report::PointAnalysis made_up_analysis(const std::string& label, std::size_t events, bool readout) {
  const MadeUpDetector detector;
  return {label, analyze_events(detector.events(events, readout), detector.setup()), {}};
}

}  // namespace

TEST_CASE("The page of events holds the numbers of every analysis and loads nothing") {
  const report::PointAnalysis point = made_up_analysis("rough", 6000, true);
  const std::string page = report::event_page("Dual-ended array", "results.h5", {point}, {});
  const EventAnalysis& analysis = point.analysis;
  for (const std::string& words :
       {report::with_error(analysis.peak.fit.position),
        report::percent_with_error(analysis.peak.fit.relative_fwhm),
        report::with_error(analysis.doi->residual.quantile_fwhm), std::string("16 peaks for 16 parts"),
        std::string("coincidence of two such detectors"), std::string("timing against depth")})
    check_contains(page, words);
  for (const char* outside : {"http:", "https:", "url(", "@import", "<link", "nan", "inf\""})
    CHECK_FALSE(contains(scripts_of(page).page, outside));
  if (const char* name = std::getenv("SCINTRAY_EVENT_PAGE")) std::ofstream(name) << page;
}

TEST_CASE("Lines for the terminal have the same numbers") {
  const std::string lines = report::event_lines(made_up_analysis("run", 6000, true).analysis, {});
  check_contains(lines, "pulses: 5");
  check_contains(lines, "spectrum: photopeak");
  check_contains(lines, "one FWHM of the photopeak");
  check_contains(lines, {"depth of interaction:", "A / (A + B)", "monotone calibration", "FWHM"});
  check_contains(lines, {"coincidence", "two", "FWHM"});
  CHECK_FALSE(contains(lines, "nan"));
}

TEST_CASE("For a point of few events the missing numbers have reasons, and labels are escaped") {
  const std::string page = report::event_page("t", "u", {made_up_analysis("<b>&", 40, false)}, {});
  check_contains(page, "&lt;b&gt;&amp;");
  CHECK_FALSE(contains(page, "<b>&"));
  check_contains(page, "too few events");
  check_contains(page, "What was left out");
  check_contains(page, {"40 events", "flood map", "100"});
  CHECK(report::event_section({}, {}).empty());
  CHECK(report::event_section({{"none", EventAnalysis{}, {}}}, {}).empty());
  CHECK(report::event_lines(EventAnalysis{}, {}).empty());
}

TEST_CASE("Points of a sweep over depth become one curve") {
  const MadeUpDetector detector;
  std::vector<report::PointAnalysis> points;
  for (const float depth : {4.0F, 10.0F, 16.0F}) {
    std::vector<EventRecord> events = detector.events(1500, true);
    for (EventRecord& event : events) event.position_mm[2] = depth;
    points.push_back({std::to_string(depth), analyze_events(events, detector.setup()), {}});
  }
  check_contains(report::event_section(points, {}), "all points: light against depth");
  points.push_back(made_up_analysis("all depths", 1500, true));
  CHECK_FALSE(contains(report::event_section(points, {}), "all points"));
  points.pop_back();
  points[1].analysis.mean_depth_mm.reset();
  CHECK_FALSE(contains(report::event_section(points, {}), "all points"));
}

TEST_CASE("Timing by order of photons is drawn with its best n, the bound, against depth and over points") {
  std::vector<std::vector<double>> events;
  for (std::size_t event = 0; event < 400; ++event) {
    Rng rng = toy_rng(70, event);
    events.push_back(sample_photon_times(200.0, 40.0, 0.1, 0.1, rng));
  }
  EventAnalysis analysis;
  analysis.events = analysis.pulses = 400;
  analysis.orders = analyze_orders(events, 10);
  const std::string plain = report::event_section({{"alone", analysis, {}}}, {});
  check_contains(plain, "best single photon ");
  CHECK_FALSE(contains(plain, "bound"));
  CHECK_FALSE(contains(plain, "all points"));

  analysis.orders_bound = timing_bound({{{40.0, 0.1, 1.0}}, 0.1}, 200.0, analysis.orders->single);
  analysis.orders_against_depth = {{4.0, 200, 200.0, *analysis.orders}, {8.0, 200, 180.0, *analysis.orders}};
  analysis.depth_bounds = {analysis.orders_bound, std::nullopt};
  const std::string drawn = report::event_section({{"one", analysis, {}}, {"two", analysis, {}}}, {});
  check_contains(drawn, "bound by all 200 photons");
  check_contains(drawn, "bound by the first n");
  check_contains(drawn, "by order of photons against depth");
  check_contains(drawn, "all points: coincidence of two such detectors by the n-th photon");
  const std::string lines = report::event_lines(analysis, {});
  check_contains(lines, "CTR by the n-th photon: n = 1: ");
  check_contains(lines, "best photon at each depth: 4 mm: photon ");
}

TEST_CASE("Effects that are not included stand beside every resolution and CTR, on the page and in lines") {
  report::PointAnalysis point = made_up_analysis("rough", 6000, true);
  point.omitted = std::vector<OmittedEffect>{
      {"intrinsic resolution", "LSO", "[intrinsic_resolution]", true, false, false},
      {"electronic noise", "", "[readout] noise", true, true, false},
      {"reflection behind the window", "pmt", "", false, false, true}};
  const std::string resolution =
      "The energy resolution does not include: intrinsic resolution (LSO); electronic noise.";
  const std::string timing = "The CTR does not include: electronic noise.";
  for (const std::string& text :
       {report::event_page("t", "u", {point}, {}), report::event_lines(point.analysis, point.omitted)}) {
    check_contains(text, resolution);
    check_contains(text, timing);
    CHECK_FALSE(contains(text, "reflection behind the window"));  // it changes neither
  }
  point.omitted->clear();
  check_contains(report::event_lines(point.analysis, point.omitted),
                 "The CTR includes every effect that is modelled.");
  check_contains(report::event_lines(point.analysis, {}),
                 "What the CTR does not include is not recorded in this result.");
}

TEST_CASE("A column without a number has the reason") {
  const MadeUpDetector detector;
  AnalysisSetup setup = detector.setup();
  setup.depth.reset();
  const EventAnalysis no_depth = analyze_events(detector.events(3000, true), setup);
  check_contains(report::event_page("t", "u", {{"run", no_depth, {}}}, {}),
                 "neither in one plane nor at two ends, and [analysis] states no direction of depth");
  setup = detector.setup();
  std::vector<EventRecord> events = detector.events(3000, true);
  for (EventRecord& event : events) event.channels.resize(2);
  setup.channels_mm.resize(2);
  const std::string page = report::event_page("t", "u", {{"run", analyze_events(events, setup), {}}}, {});
  check_contains(page, "none: 2 readout channels");
  check_contains(page, "none: the readout channels are at one end");
  CHECK_FALSE(contains(page, "<td class=\"n\"></td>"));
}

TEST_CASE("A spectrum has its energies, and each crystal its number, its light and its spectrum") {
  const report::PointAnalysis point = made_up_analysis("rough", 6000, true);
  report::PartNames names;
  for (const PartLight& part : point.analysis.parts)
    while (names.size() <= part.part.index())
      names.push_back("crystal[" + std::to_string(names.size()) + "]");
  const std::string page = report::event_page("t", "u", {point}, names);
  check_contains(page, "energy (keV), at the mean light per keV");
  check_contains(page, "x by Anger logic (mm)");
  check_contains(page, "y by Anger logic (mm)");
  check_contains(page, "<path class=\"border\"");  // between the regions of the peaks
  REQUIRE(point.analysis.parts.size() == 16);
  for (std::size_t i = 0; i < 16; ++i) {
    const PartLight& part = point.analysis.parts[i];
    check_contains(page, {names[part.part], report::with_error(part.peak.fit.position), "small-spectrum"});
    check_contains(page, {"mark-text", ">" + std::to_string(i + 1) + "</text>"});
  }
  std::uint64_t pulses = 0;
  for (const PartLight& part : point.analysis.parts) pulses += part.pulses;
  CHECK(pulses == point.analysis.pulses);
}

TEST_CASE("Crystals away from the source are visible: colours are logarithmic where peaks differ") {
  const MadeUpDetector detector;
  std::vector<EventRecord> events = detector.events(12'000, true);
  const std::string even =
      report::event_page("t", "u", {{"run", analyze_events(events, detector.setup()), {}}}, {});
  CHECK_FALSE(contains(even, "events per cell, logarithmic"));
  const PartId bright = events.front().part;
  std::size_t kept = 0;
  std::erase_if(events, [&](const EventRecord& event) { return event.part != bright && ++kept % 12 != 0; });
  const std::string uneven =
      report::event_page("t", "u", {{"run", analyze_events(events, detector.setup()), {}}}, {});
  check_contains(uneven, "events per cell, logarithmic");
}

TEST_CASE("A point without a flood map says why where the map would be") {
  const std::string page = report::event_page("t", "u", {made_up_analysis("few", 40, false)}, {});
  check_contains(page, {"few: no flood map", "100"});
}

TEST_CASE("A flood map has the outlines of the crystals as far as they lie on it, where they are available") {
  PointAnalysis point = made_up_analysis("run", 6'000, true);
  REQUIRE(point.analysis.flood);
  const std::string without = report::event_page("t", "u", {point}, {});
  CHECK_FALSE(contains(without, "<path class=\"outline\""));
  CHECK_FALSE(contains(without, "the crystals where they stand"));
  const FloodGrid& grid = point.analysis.flood->grid;
  const double far = grid.x_high + 1.0;
  point.crystals = {{grid.x_low, grid.y_low, 0.5 * (grid.x_low + grid.x_high), grid.y_high},
                    {far, grid.y_low, far + 1.0, grid.y_high}};
  const std::string page = report::event_page("t", "u", {point}, {});
  check_contains(page, "dashed ones the crystals where they stand");
  const std::size_t at = page.find("<path class=\"outline\" d=\"");
  REQUIRE(at != std::string::npos);
  const std::string path = page.substr(at, page.find("/>", at) - at);
  CHECK(std::count(path.begin(), path.end(), 'M') == 1);  // the second lies beside the map
}
