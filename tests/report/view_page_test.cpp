// Pages of scenes in three dimensions.
#include <doctest/doctest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "scintray/mesh/shapes/primitives.hpp"
#include "scintray/report/pages/pages.hpp"
#include "scintray/report/view/view_page.hpp"
#include "support/made_up_result.hpp"
#include "support/page_scripts.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::report;
using namespace scintray::test;

namespace {

/// The data of a page.
nlohmann::json data_of(const std::string& page) {
  const std::string begin = "<script type=\"application/json\" id=\"data\">";
  const std::size_t first = page.find(begin) + begin.size();
  return nlohmann::json::parse(page.substr(first, page.find("</script>", first) - first));
}

}  // namespace

TEST_CASE("a page holds parts, faces, paths and findings, equal shapes once, and all that it needs") {
  if (!can_view()) return;
  const mesh::TriMesh one = mesh::make_box({0, 0, 0}, {1, 2, 3}),
                      other = mesh::make_box({10, 0, 0}, {11, 2, 3}),
                      larger = mesh::make_box({0, 0, -1}, {20, 20, 0});
  const std::vector<std::uint32_t> all_first(one.triangles.size(), 0);
  SceneView view{"two crystals </script><b>", {}, {}, {}};
  view.parts.push_back({"a", "LSO", &one, {{"other", "ground", "", "a.toml:3"}}, all_first});
  view.parts.push_back({"b", "LSO", &other, {{"other", "ground", "", "a.toml:3"}}, all_first});
  view.parts.push_back({"c", "sensor", &larger, {{"other", "", "sipm", ""}}, all_first});
  view.paths.push_back(
      {0,
       3,
       Fate::not_detected,
       {{{0.5, 1, 1}, 0.0, 420.0, "emitted in a"}, {{0.5, 1, 0}, 0.01, 420.0, "not detected by c"}}});
  view.marks.push_back({"a gap", {{1, 2, 3}}});
  view.tallies.push_back({"returned", "share", {0.5, std::nan(""), 0.25}, std::nullopt, {}});
  view.tallies.push_back(
      {"map", "share", {}, ViewGrid{{{{1, 0, 0}, {0, 1, 0}}}, {0, 1}, {2, 3}, {1, 2}, {4, 5}}, {2}});
  const std::string page = view_page(view);

  const nlohmann::json data = data_of(page);
  CHECK(data["title"] == view.title);
  REQUIRE(data["parts"].size() == 3);
  CHECK(data["shapes"].size() == 2);
  CHECK(data["parts"][0]["s"] == data["parts"][1]["s"]);
  CHECK(data["parts"][1]["o"] == nlohmann::json({10.0, 0.0, 0.0}));
  CHECK(data["surfaces"][data["faces"][0][0]["s"].get<std::size_t>()]["n"] == "ground");
  CHECK(data["fates"] == nlohmann::json({"not detected"}));
  CHECK(data["events"].size() == 2);
  CHECK(data["faces"][0][0]["w"] == "a.toml:3");
  CHECK(data["left_out"] == 0);
  CHECK(data["paths"][0]["n"] == "event 0, photon 3");
  CHECK(data["paths"][0]["k"] == 2);
  CHECK(data["paths"][0]["w"] == nlohmann::json({{0, 420.0}}));
  CHECK(data["marks"][0]["p"][0] == nlohmann::json({1.0, 2.0, 3.0}));

  REQUIRE(data["tallies"].size() == 2);
  CHECK(data["tallies"][0]["v"].get<std::string>().size() == 16);  // three numbers of four bytes
  CHECK_FALSE(data["tallies"][0].contains("g"));
  CHECK(data["tallies"][1]["g"]["b"] == nlohmann::json({0.0, 2.0, 1.0, 3.0}));
  CHECK(data["tallies"][1]["g"]["n"] == nlohmann::json({1, 2}));

  CHECK(contains(page, "two crystals &lt;/script&gt;&lt;b&gt;"));
  CHECK(contains(page, "WebGLRenderer"));
  CHECK(contains(page, "OrbitControls"));
  CHECK_FALSE(contains(page, "@@"));
  for (const char* const loads : {"<script src", "<link", "@import", "url(http"})
    CHECK_FALSE(contains(page, loads));
}

TEST_CASE("A page holds so many steps of photon paths, and the number of paths that it leaves out") {
  SceneView view{"", {}, {}, {}};
  const tally::PathStep step{{0, 0, 0}, 0.0, 420.0, "reflected"};
  for (std::uint64_t photon = 0; photon < 4; ++photon)
    view.paths.push_back({0, photon, Fate::escaped, std::vector<tally::PathStep>(kMostViewSteps / 3, step)});
  const nlohmann::json data = data_of(view_section({view, ""}, made_up_run()));
  CHECK(data["paths"].size() == 3);
  CHECK(data["left_out"] == 1);
}

TEST_CASE("A report has the scene with what the run counted there, or why it has not, or neither") {
  const tally::RunResult run = made_up_run();
  CHECK_FALSE(contains(html_report(run), "three dimensions"));
  const std::string without = html_report(run, {}, {std::nullopt, "cube.stl: there is no such file"});
  check_contains(without, "The scene is not shown: cube.stl: there is no such file.");
  CHECK_FALSE(contains(without, "WebGLRenderer"));
  if (!can_view()) return;
  const mesh::TriMesh box = mesh::make_box({0, 0, 0}, {1, 2, 3});
  const std::vector<std::uint32_t> all_first(box.triangles.size(), 0);
  SceneView view{"", {{"a", "LSO", &box, {{"exit", "ground", "", ""}}, all_first}}, {}, {}};
  const std::string page = html_report(run, {}, {view, ""});
  const PageScripts scripts = scripts_of(page);
  CHECK(scripts.code.size() >= 3);
  check_contains(scripts.page, "class=\"view-open\"");
  check_contains(scripts.page, "paths = 500");
  std::size_t three = 0;
  for (const std::string& code : scripts.code)
    three += contains(code, "WebGLRenderer =") || contains(code, "REVISION=") ? 1 : 0;
  CHECK(three == 1);
  const nlohmann::json ledger = data_of(page)["ledger"];
  CHECK(ledger["n"] == run.points[0].photons);
  CHECK(ledger["media"].size() == run.header.media.size());
  std::uint64_t detected = 0;
  for (const auto& counts : ledger["parts"]) detected += counts[0].get<std::uint64_t>();
  CHECK(detected == run.points[0].count(Fate::detected));
}
