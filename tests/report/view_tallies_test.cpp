// Tallies that a view paints on faces.
#include "scintray/report/view/view_page.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "scintray/mesh/shapes/primitives.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::report;
using namespace scintray::test;

namespace {

/// A crystal with an exit face and the rest, and a sensor.
std::vector<ViewPart> two_parts() {
  static const mesh::TriMesh box = mesh::make_box({0, 0, 0}, {1, 2, 3});
  const std::vector<std::uint32_t> all_first(box.triangles.size(), 0);
  return {{"crystal", "LSO", &box, {{"exit", "", "", ""}, {"other", "", "", ""}}, all_first},
          {"pmt", "sensor", &box, {{"window", "", "ideal", ""}}, all_first}};
}

tally::RunHeader header_of_two_parts() {
  tally::RunHeader header;
  header.parts = {"crystal", "pmt"};
  header.faces = {"crystal:exit", "crystal:other", "pmt:window"};
  return header;
}

tally::TallyAxis positions(std::array<double, 3> along, double low, double high, std::size_t bins) {
  tally::TallyAxis axis;
  axis.variable = "position";
  axis.unit = "mm";
  axis.along = along;
  for (std::size_t i = 0; i <= bins; ++i)
    axis.edges.push_back(low + (high - low) * static_cast<double>(i) / static_cast<double>(bins));
  return axis;
}

tally::TallyResult tally_over(const std::string& name, std::vector<tally::TallyAxis> axes) {
  tally::TallyResult tally;
  tally.name = name;
  tally.type = "count";
  tally.score = "photons";
  tally.unit = "1";
  tally.axes = std::move(axes);
  tally.sum.assign(tally.bins(), 0.0);
  return tally;
}

scene_file::TallySpec bound_to(const std::string& name, const std::string& face) {
  scene_file::TallySpec spec;
  spec.name = name;
  spec.faces = {{face, {}}};
  return spec;
}

}  // namespace

TEST_CASE("Counts over faces are painted event by event, and faces without a bin have no value") {
  tally::PointResult point;
  point.emitted = 1000;
  tally::TallyAxis faces, events;
  faces.variable = "face";
  faces.names = {"pmt:window", "crystal:exit"};
  events.variable = "occasion";
  events.names = {"returned", "absorbed_at_surface", "escaped"};
  point.tallies = {tally_over("ledger", {faces, events})};
  point.tallies[0].sum = {1, 20, 0, 300, 4, 0};
  const auto painted = view_tallies(header_of_two_parts(), point, {}, two_parts());
  REQUIRE(painted.size() == 2);  // nothing escaped
  CHECK(painted[0].name == "ledger: returned");
  CHECK(painted[1].name == "ledger: absorbed at surface");
  REQUIRE(painted[1].of_faces.size() == 3);
  CHECK(painted[1].of_faces[0] == doctest::Approx(0.004));  // crystal:exit
  CHECK(std::isnan(painted[1].of_faces[1]));
  CHECK(painted[1].of_faces[2] == doctest::Approx(0.02));
}

TEST_CASE("A grid on faces is summed over its other axes, and lies on the faces of its pattern") {
  tally::PointResult point;
  point.emitted = 10;
  tally::TallyAxis time;
  time.variable = "time";
  time.unit = "ns";
  time.edges = {0, 1, 2};
  point.tallies = {tally_over("map", {positions({1, 0, 0}, 0, 2, 2), time, positions({0, 1, 0}, -1, 2, 3)}),
                   tally_over("angles", {time, time}),
                   tally_over("unbound", {positions({1, 0, 0}, 0, 2, 2), time})};
  for (std::size_t i = 0; i < point.tallies[0].sum.size(); ++i)
    point.tallies[0].sum[i] = static_cast<double>(i);
  const auto painted = view_tallies(header_of_two_parts(), point, {bound_to("map", "cry*:*")}, two_parts());
  REQUIRE(painted.size() == 1);
  const ViewTally& map = painted[0];
  REQUIRE(map.grid);
  CHECK(map.faces == std::vector<std::uint32_t>{0, 1});
  CHECK(map.grid->bins == std::array<std::size_t, 2>{2, 3});
  CHECK(map.grid->low_mm == std::array<double, 2>{0, -1});
  CHECK(map.grid->high_mm == std::array<double, 2>{2, 2});
  // Bin (i, t, j) is 6 i + 3 t + j: over t, 12 i + 3 + 2 j.
  REQUIRE(map.grid->values.size() == 6);
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      CHECK(map.grid->values[3 * i + j] == doctest::Approx(static_cast<double>(12 * i + 3 + 2 * j) / 10.0));
}

TEST_CASE("A fine grid is joined so far that a page holds it, and keeps its sum and its places") {
  tally::PointResult point;
  point.emitted = 1;
  const std::size_t bins = 2 * kMostViewBins + 1;
  point.tallies = {tally_over(
      "map", {positions({1, 0, 0}, 0, static_cast<double>(bins), bins), positions({0, 1, 0}, 0, 1, 1)})};
  point.tallies[0].sum.assign(bins, 1.0);
  point.tallies[0].sum[5] = 100.0;
  const auto painted =
      view_tallies(header_of_two_parts(), point, {bound_to("map", "pmt:window")}, two_parts());
  REQUIRE(painted.size() == 1);
  const ViewGrid& grid = *painted[0].grid;
  CHECK(grid.bins[0] == (bins + 2) / 3);
  CHECK(grid.values[1] == 102.0);  // bins 3 to 5
  CHECK(grid.high_mm[0] == doctest::Approx(3.0 * static_cast<double>(grid.bins[0])));
  double sum = 0.0;
  for (const double value : grid.values) sum += value;
  CHECK(sum == static_cast<double>(bins) + 99.0);
}

TEST_CASE("Light at sensor faces is painted without any tally") {
  tally::PointResult point;
  point.emitted = 200;
  point.sensor_faces = {{core::PartId(1), core::FaceId(2), 50, 0}};
  const auto painted = view_tallies(header_of_two_parts(), point, {}, two_parts());
  REQUIRE(painted.size() == 1);  // all of it was detected
  check_contains(painted[0].name, "detected");
  CHECK(painted[0].of_faces[2] == doctest::Approx(0.25));
  CHECK(std::isnan(painted[0].of_faces[0]));
  point.emitted = 0;
  CHECK(view_tallies(header_of_two_parts(), point, {}, two_parts()).empty());
}
