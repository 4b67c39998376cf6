#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "scintray/core/error.hpp"
#include "scintray/report/pages/pages.hpp"
#include "scintray/report/plots/svg_plot.hpp"
#include "scintray/report/text/format.hpp"
#include "scintray/report/text/sweep_view.hpp"
#include "scintray/report/text/text_summary.hpp"
#include "support/made_up_result.hpp"
#include "support/page_scripts.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::tally;
using namespace scintray::analysis;
using namespace scintray::report;
using namespace scintray::test;

namespace {

/// "" when every tag of the page closes in order and every & starts an entity; else what is wrong.
std::string markup_fault(const std::string& page) {
  std::vector<std::string> open;
  const std::set<std::string> entities{"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"};
  for (std::size_t i = 0; i < page.size(); ++i) {
    if (page[i] == '&') {
      const std::string entity = page.substr(i, page.find(';', i) - i + 1);
      if (entities.count(entity) == 0) return "bare &: " + page.substr(i, 20);
    }
    if (page[i] == '>') return "bare >: " + page.substr(i, 20);
    if (page[i] != '<') continue;
    const std::size_t end = page.find('>', i);
    if (end == std::string::npos) return "tag without end";
    const std::string tag = page.substr(i + 1, end - i - 1);
    if (contains(tag, "<")) return "< inside a tag: " + tag;
    if (std::count(tag.begin(), tag.end(), '"') % 2 != 0) return "odd quotes: " + tag;
    i = end;
    if (tag[0] == '!' || tag.back() == '/') continue;
    const std::string name =
        tag.substr(tag[0] == '/' ? 1 : 0, tag.find_first_of(" ") - (tag[0] == '/' ? 1 : 0));
    if (tag[0] != '/') {
      open.push_back(name);
      if (name == "style" || name == "script") i = page.find("</" + name + ">", i) - 1;
    } else if (open.empty() || open.back() != name) {
      return "</" + name + "> closes " + (open.empty() ? "nothing" : open.back());
    } else {
      open.pop_back();
    }
  }
  return open.empty() ? "" : "left open: " + open.back();
}

}  // namespace

TEST_CASE("The page is well formed and loads nothing") {
  RunResult run = test::made_up_run();
  CHECK(markup_fault("<p>a</b>") != "");  // the check itself can fail
  CHECK(markup_fault("<p>a & b</p>") != "");
  for (const int points : {15, 1, 0}) {
    CAPTURE(points);
    run.points.resize(static_cast<std::size_t>(points));
    const std::string page = html_report(run);
    CHECK(markup_fault(page) == "");
    CHECK(markup_fault(html_report(run, {}, {SceneView{}, ""})) == "");
    const PageScripts scripts = scripts_of(page);
    for (const char* outside : {"http:", "https:", "src=", "url(", "@import", "<link", "nan", "inf\""})
      CHECK_FALSE(contains(scripts.page, outside));
    for (const std::string& code : scripts.code)
      for (const char* outside : {"fetch(", "XMLHttpRequest", "import(", "WebSocket"})
        CHECK_FALSE(contains(code, outside));
  }
}

TEST_CASE("A page allows its own script and no other, and every plot has its numbers") {
  RunResult run = test::made_up_run();
  run.points.resize(5);
  const std::string page = html_report(run);
  const PageScripts scripts = scripts_of(page);
  const std::string policy = "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; ";
  check_contains(page, policy);
  CHECK(page.find(policy) < page.find("<style"));
  CHECK_FALSE(contains(page.substr(page.find(policy), 400), "script-src 'unsafe-inline'"));
  std::size_t hashes = 0, plots = 0;
  for (std::size_t at = page.find("'sha256-"); at != std::string::npos; at = page.find("'sha256-", at + 1))
    ++hashes;
  CHECK(hashes == scripts.code.size());
  for (std::size_t at = page.find("<svg class=\"plot\""); at != std::string::npos;
       at = page.find("<svg class=\"plot\"", at + 1))
    ++plots;
  CHECK(plots > 2);
  CHECK(scripts.data.size() == plots);
  for (const std::string& data : scripts.data) CHECK(nlohmann::json::parse(data).contains("series"));
  const nlohmann::json sweep = nlohmann::json::parse(scripts.data.front());
  CHECK(sweep["series"][0]["y"][2].get<double>() ==
        doctest::Approx(run.points[2].fraction(Fate::detected).value).epsilon(1e-6));
}

TEST_CASE("Data of a plot hold what a script element may not") {
  report::Plot plot;
  plot.title = "</script><b>\"\\";
  plot.series = {{"<!--", {0, 1}, {std::nan(""), 2.5e-7}, {}, false}};
  const PageScripts scripts = scripts_of(report::chart(plot));
  REQUIRE(scripts.data.size() == 1);
  const nlohmann::json data = nlohmann::json::parse(scripts.data[0]);
  CHECK(data["title"] == plot.title);
  CHECK(data["series"][0]["n"] == "<!--");
  CHECK(data["series"][0]["y"][0].is_null());
  CHECK(data["series"][0]["y"][1] == 2.5e-7);
  CHECK(data["xr"].size() == 2);
  CHECK(markup_fault(report::chart(plot)) == "");
}

TEST_CASE("Text from scenes is escaped everywhere") {
  RunResult run = test::made_up_run();
  const std::string evil = "<b>&\"'";
  run.header.title = run.header.scene_file = run.header.note = run.header.scene_text = evil;
  run.header.version = run.partial_reason = evil;
  for (std::string& name : run.header.media) name = evil;
  for (std::string& name : run.header.surfaces) name = evil;
  for (std::string& name : run.header.parts) name = evil;
  for (std::string& name : run.header.faces) name = evil;
  run.header.sweep_keys[0] = run.header.sweep_keys[1] = evil;
  for (PointResult& point : run.points) {
    point.parameters[0] += evil;
    std::vector<TallyResult> renamed;
    for (CrossingAngles& angles : crossing_angles(point)) {
      angles.name = evil;
      for (TallyResult& tally : tallies_of(angles)) renamed.push_back(std::move(tally));
    }
    point.tallies = std::move(renamed);
  }
  const std::string page = html_report(run);
  CHECK_FALSE(contains(page, "<b>&\""));
  CHECK(contains(page, "&lt;b&gt;&amp;&quot;&#39;"));
  CHECK(markup_fault(page) == "");
}

TEST_CASE("The page holds the numbers of the run") {
  const RunResult run = test::made_up_run();
  const std::string page = html_report(run);
  CHECK(contains(page, report::with_error(run.points[7].fraction(Fate::detected))));
  CHECK(contains(page, "18364758544493064720"));  // the seed
  CHECK(contains(page, "absorbed in LSO"));
  CHECK(contains(page, "pmt:window"));
  CHECK(contains(page, "second warning"));
  CHECK_FALSE(contains(page, "Partial result"));
}

TEST_CASE("A partial run is marked as such, on the page and in the terminal") {
  RunResult run = test::made_up_run();
  run.partial_reason = "interrupted by Ctrl-C";
  CHECK(contains(html_report(run), "<b>Partial result.</b> interrupted by Ctrl-C."));
  CHECK(contains(text_summary(run), "PARTIAL RESULT: interrupted by Ctrl-C."));
}

TEST_CASE("Numbers are written to the decimal place of their error") {
  CHECK(report::with_error({0.33731, 0.00112}) == "0.3373 ± 0.0011");
  CHECK(report::with_error({1234.6, 53.2}) == "1235 ± 53");
  CHECK(report::with_error({12.5, 1.26}) == "12.5 ± 1.3");
  CHECK(report::percent_with_error({0.5, 0.001}) == "50.00 ± 0.10 %");
  CHECK(report::grouped(999) == "999");
  CHECK(report::display_width("0.1 ± 0.2") == 9);
}

TEST_CASE("Ticks are multiples of 1, 2 or 5 and cover the data") {
  const std::vector<std::pair<double, double>> ranges{{0.0, 0.43}, {2.0, 18.0}, {-7e-9, 3e-9}, {1e6, 1.3e6}};
  for (const auto& [low, high] : ranges) {
    const auto ticks = report::nice_ticks(low, high, 5);
    CHECK(ticks.size() >= 4);
    CHECK(ticks.size() <= 8);
    CHECK(ticks.front() <= low + 1e-9 * (high - low));
    CHECK(ticks.back() >= high - 1e-9 * (high - low));
    const double step = ticks[1] - ticks[0];
    const double mantissa = step / std::pow(10.0, std::floor(std::log10(step * 1.000001)));
    CHECK((std::abs(mantissa - 1) < 1e-6 || std::abs(mantissa - 2) < 1e-6 || std::abs(mantissa - 5) < 1e-6));
  }
}

TEST_CASE("A plot draws zeros on a logarithmic axis as gaps and refuses ragged series") {
  report::Plot plot;
  plot.log_y = true;
  plot.series = {{"a", {0, 1, 2}, {10, 0, 1000}, {}, false}};
  const std::string svg = report::svg_plot(plot);
  CHECK(markup_fault(svg) == "");
  CHECK_FALSE(contains(svg, "inf"));
  CHECK_FALSE(contains(svg, "nan"));
  plot.series[0].x.pop_back();
  CHECK_THROWS_AS(report::svg_plot(plot), std::invalid_argument);
}

TEST_CASE("A legend too long for one row takes two, and the plot makes room") {
  report::Plot plot;
  plot.width = 480.0;
  for (const char* name : {"ground, UNIFIED, 2 mm", "ground, UNIFIED, 18 mm"})
    plot.series.push_back({name, {0, 1, 2}, {3, 4}, {}, true});
  const std::string two_rows = report::svg_plot(plot);
  CHECK(contains(two_rows, "y=\"23.00\" class=\"name c0\""));
  CHECK(contains(two_rows, "y=\"45.00\" class=\"name c1\""));
  plot.width = 860.0;
  CHECK(contains(report::svg_plot(plot), "y=\"23.00\" class=\"name c1\""));
}

TEST_CASE("A sweep becomes one curve for each setting of the other keys") {
  RunResult run = test::made_up_run();
  const auto view = report::view_sweep(run);
  REQUIRE(view);
  CHECK(view->key == "source.region.slab_z.center");
  CHECK(view->unit == "mm");
  CHECK(view->rows == std::vector<std::string>{"2 mm", "6 mm", "10 mm", "14 mm", "18 mm"});
  REQUIRE(view->series.size() == 3);
  CHECK(view->series[1].label == "ground, table");
  CHECK(view->series[1].points == std::vector<std::size_t>{5, 6, 7, 8, 9});
  run.points[2].parameters[1] = "1 cm";  // another unit: not one axis
  CHECK_FALSE(report::view_sweep(run));
}

TEST_CASE("The terminal summary is an aligned table") {
  RunResult run = test::made_up_run();
  const std::string sweep = text_summary(run);
  std::istringstream lines(sweep);
  std::string line;
  std::getline(lines, line);
  CHECK(line == "Detected fraction");
  std::set<std::size_t> widths;
  for (int row = 0; row < 6 && std::getline(lines, line); ++row) {
    CHECK(contains(line, row == 0 ? "polished       ground, table   ground, UNIFIED" : " mm   "));
    widths.insert(report::display_width(line));
  }
  CHECK(widths.size() == 1);  // the last column is flush right
  CHECK(contains(sweep, report::with_error(run.points[0].fraction(Fate::detected))));
  CHECK(contains(sweep, "Lost photons: 0."));
  run.points.resize(1);
  CHECK(contains(text_summary(run), "absorbed at surface"));
  run.points[0].lost = 2;
  CHECK(contains(text_summary(run), "LOST PHOTONS: 2"));
}

TEST_CASE("A report that cannot be written leaves nothing and is an error with the reason") {
  const auto folder = test::scratch_folder("report_write");
  const RunResult run = test::made_up_run();
  write_report(folder / "run.html", run);
  std::ifstream in(folder / "run.html");
  std::ostringstream text;
  text << in.rdbuf();
  CHECK(text.str() == html_report(run));
  try {
    write_report(folder / "no" / "run.html", run);
    FAIL("written into a folder that does not exist");
  } catch (const SystemError& error) {
    CHECK(contains(error.what(), "run.html: cannot write the report: No such file or directory"));
  }
}

TEST_CASE("Page and summary say how many photons were traced, and count each fate for all photons") {
  tally::RunResult run = test::made_up_run();
  tally::PointResult& point = run.points[0];
  run.points.resize(1);
  point.emitted = 4 * point.photons;
  point.birth_efficiency = 0.25;
  const std::string page = html_report(run);
  CHECK(contains(page, "of them traced"));
  const double detected = 0.25 * static_cast<double>(point.count(core::Fate::detected));
  const double photons = static_cast<double>(point.photons);
  CHECK(point.fraction(core::Fate::detected).value == detected / photons);
  CHECK(point.fraction(core::Fate::not_detected).value ==
        doctest::Approx((static_cast<double>(point.count(core::Fate::not_detected)) + 3.0 * detected) /
                        photons));
  CHECK(contains(page, percent_with_error(point.fraction(core::Fate::detected))));
  CHECK(contains(text_summary(run), "no sensor converts more than 0.25"));
}

TEST_CASE("A tally of nothing has the reason, not an empty map") {
  RunResult run = test::made_up_run();
  run.points.resize(1);
  TallyResult spread;
  spread.name = "light_spread at crystal:exit";
  spread.type = "light_spread";
  spread.score = "photons";
  for (const double along : {0.0, 1.0}) {
    TallyAxis axis{"position", "mm", {-1.0, 0.0, 1.0}, {}, {}};
    axis.along[along > 0.0 ? 1 : 0] = 1.0;
    spread.axes.push_back(axis);
  }
  spread.sum = spread.sum_of_squares = {0.0, 0.0, 0.0, 0.0};
  run.points[0].tallies = {spread};
  for (const std::string& text : {html_report(run), text_summary(run)}) {
    check_contains(text, {"nothing was counted", "through pmt:window, pmt:side"});
    CHECK_FALSE(contains(text, "e-300"));
  }
  run.points[0].tallies[0].outside = 5.0;
  check_contains(text_summary(run), {"nothing was counted within its axes", "wider"});
  run.points[0].tallies[0].sum[1] = 3.0;
  CHECK_FALSE(contains(text_summary(run), "nothing was counted"));
}

TEST_CASE("A page has its landmarks and a list of contents, and the keyboard reaches all that scrolls") {
  const std::string page = html_report(test::made_up_run());
  check_contains(page, "<main>");
  check_contains(page, "<nav class=\"contents\"");
  std::size_t sections = 0;
  for (std::size_t at = page.find("<h2 id=\""); at != std::string::npos;
       at = page.find("<h2 id=\"", at + 1)) {
    const std::size_t start = at + 8;
    const std::string id = page.substr(start, page.find('"', start) - start);
    check_contains(page, "<li><a href=\"#" + id + "\">");
    ++sections;
  }
  CHECK(sections >= 5);
  CHECK_FALSE(contains(page, "<div class=\"scroll\">"));
  CHECK_FALSE(contains(page, "<pre>"));
  CHECK_FALSE(contains(page, "minmax(24rem"));  // wider than a phone
}

namespace {

/// Relative luminance of "#rgb" or "#rrggbb" (WCAG 2.2, "relative luminance").
double luminance(const std::string& colour) {
  const std::size_t digits = colour.size() == 4 ? 1 : 2;
  const double weights[] = {0.2126, 0.7152, 0.0722};
  double sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    std::string hex = colour.substr(1 + digits * i, digits);
    if (digits == 1) hex += hex;
    const double share = std::stoi(hex, nullptr, 16) / 255.0;
    sum += weights[i] * (share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4));
  }
  return sum;
}

/// Contrast of two colours (WCAG 2.2, "contrast ratio"), 1 to 21.
double contrast(const std::string& a, const std::string& b) {
  const double one = luminance(a), other = luminance(b);
  return (std::max(one, other) + 0.05) / (std::min(one, other) + 0.05);
}

/// Colours of a page's style by the names of their variables, without those of the dark scheme or with them.
std::map<std::string, std::string> colours_of(const std::string& style, bool dark) {
  std::map<std::string, std::string> colours;
  const std::regex variable("--([a-z0-9-]+):(#[0-9a-f]+)"),
      scheme(R"(@media screen and \(prefers-color-scheme: dark\) \{\s*:root \{[^}]*\})");
  const auto read = [&](const std::string& text) {
    for (auto at = std::sregex_iterator(text.begin(), text.end(), variable); at != std::sregex_iterator();
         ++at)
      colours[(*at)[1]] = (*at)[2];
  };
  read(std::regex_replace(style, scheme, ""));
  if (dark)
    for (auto at = std::sregex_iterator(style.begin(), style.end(), scheme); at != std::sregex_iterator();
         ++at)
      read(at->str());
  return colours;
}

}  // namespace

TEST_CASE("Text of a page has a contrast of 4.5 to 1: labels of bars, names of curves, columns, banners") {
  const std::string page = html_report(test::made_up_run());
  const std::size_t begin = page.find("<style>");
  const std::string style = page.substr(begin, page.find("</style>") - begin);
  CHECK(contrast("#fff", "#000000") == doctest::Approx(21.0));
  for (const bool dark : {false, true}) {
    CAPTURE(dark);
    const auto colours = colours_of(style, dark);
    const auto check = [&](const std::string& ink, const std::string& paper) {
      CAPTURE(ink);
      CAPTURE(paper);
      CHECK(contrast(ink, paper) >= 4.5);
    };
    // Labels of bars are white but where the style states another ink.
    std::map<std::string, std::string> inks;
    for (int i = 0; i < 6; ++i) inks["f" + std::to_string(i)] = "#fff";
    const std::regex rule(R"(((?:\.bar \.f[0-9](?:, )?)+) \{ color: (#[0-9a-f]+); \})"), one("f[0-9]");
    for (auto at = std::sregex_iterator(style.begin(), style.end(), rule); at != std::sregex_iterator();
         ++at) {
      const bool of_dark = style.substr(0, static_cast<std::size_t>(at->position())).ends_with("dark) { ");
      if (of_dark && !dark) continue;
      const std::string names = (*at)[1];
      for (auto name = std::sregex_iterator(names.begin(), names.end(), one); name != std::sregex_iterator();
           ++name)
        inks[name->str()] = (*at)[2];
    }
    for (const auto& [name, ink] : inks) check(ink, colours.at(name));
    for (int i = 0; i < 7; ++i) check(colours.at("t" + std::to_string(i)), colours.at("paper"));
    for (const char* text : {"ink", "soft"}) check(colours.at(text), colours.at("paper"));
    check(colours.at("alarm"), colours.at("alarm-paper"));
  }
}

TEST_CASE("A long table is folded") {
  RunResult run = test::made_up_run();
  run.points.resize(5);
  const PointResult point = run.points.front();
  check_contains(html_report(run), "<td class=\"n\">");
  CHECK_FALSE(contains(html_report(run), "<summary>Table of "));
  for (int i = 0; i < 40; ++i) {
    run.points.push_back(point);
    run.points.back().parameters = {"polished", std::to_string(i) + " mm"};
  }
  check_contains(html_report(run), "<summary>Table of ");
}

TEST_CASE("A page of photons on a block of sensors says why it has no flood map") {
  RunResult run = test::made_up_run();
  CHECK_FALSE(contains(html_report(run), "No flood map"));  // one sensor
  for (PointResult& point : run.points)
    for (int i = 0; i < 2; ++i) point.sensor_faces.push_back(point.sensor_faces.front());
  const std::string page = html_report(run);
  check_contains(page, {"No flood map", "photons, not events", "gamma_events"});
  CHECK(page.find("No flood map") > page.find("Where every photon ended"));  // the answer is first
}
