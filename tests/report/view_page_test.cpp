// Pages of scenes in three dimensions.
#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "scintray/mesh/shapes/primitives.hpp"
#include "scintray/report/view/view_page.hpp"
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
  view.parts.push_back({"a", "LSO", &one, {{"other", "ground", ""}}, all_first});
  view.parts.push_back({"b", "LSO", &other, {{"other", "ground", ""}}, all_first});
  view.parts.push_back({"c", "sensor", &larger, {{"other", "", "sipm"}}, all_first});
  view.paths.push_back(
      {"event 0, photon 3",
       Fate::not_detected,
       {{{0.5, 1, 1}, 0.0, 420.0, "emitted in a"}, {{0.5, 1, 0}, 0.01, 420.0, "not detected by c"}}});
  view.marks.push_back({"a gap", {{1, 2, 3}}});
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
  CHECK(data["marks"][0]["p"][0] == nlohmann::json({1.0, 2.0, 3.0}));

  CHECK(contains(page, "two crystals &lt;/script&gt;&lt;b&gt;"));
  CHECK(contains(page, "WebGLRenderer"));
  CHECK(contains(page, "OrbitControls"));
  CHECK_FALSE(contains(page, "@@"));
  for (const char* const loads : {"<script src", "<link", "@import", "url(http"})
    CHECK_FALSE(contains(page, loads));
}
