// Variables of tallies from outside: nothing of ScintRay knows them but the list that the caller passes.
#include "scintray/scene_file/tally_variable.hpp"

#include <numeric>

#include "physics/traced.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene_file;
using namespace scintray::tally;
using namespace scintray::test;

namespace {

/// Distance from where it was emitted, a number.
double reach(const StepView& view, const Vec3&) { return (view.position - view.start).norm(); }

/// Angle by which the event turned the photon, a number that changes with every total reflection.
double turn(const StepView& view, const Vec3&) {
  return std::acos(std::clamp(view.direction.dot(view.direction_before), -1.0, 1.0));
}

/// The part that it was emitted in, among all parts.
std::uint32_t birthplace(const StepView& view) { return place_of(view.source_part); }

TallyVariables with_toys() {
  TallyVariables variables;
  variables.add({.name = "reach", .dimension = Dimension::length, .number = reach});
  variables.add({.name = "turn",
                 .dimension = Dimension::angle,
                 .low = 0.0,
                 .high = kPi,
                 .direction_before = true,
                 .number = turn});
  variables.add({.name = "birthplace", .kind = VariableKind::part, .place = birthplace});
  return variables;
}

/// A beam from 2 mm above the lower end of a crystal of index 1.82, 2 x 2 x 5 mm, near its wall x = 1 mm.
std::string crystal(const std::string& direction) {
  return fmt::format(R"(
ambient = "vacuum_n1"
[[part]]
name = "crystal"
box = {{ low = ["-1 mm", "-1 mm", "0 mm"], high = ["1 mm", "1 mm", "5 mm"] }}
medium = "lso_clear"
surface = "flat"
[source]
type = "photons"
position = ["0.9 mm", "0 mm", "2 mm"]
direction = {}
wavelength = "500 nm"
photons = 100
)",
                     direction);
}

double sum_of(const TallyResult& tally) { return std::accumulate(tally.sum.begin(), tally.sum.end(), 0.0); }

}  // namespace

TEST_CASE("A variable from outside is an axis, a condition and a score as the built-in ones are") {
  const std::string scene = crystal("[0, 0, -1]") + R"(
[[tally]]
type = "count"
name = "axis"
at = "crossed"
axes = [{ variable = "reach", from = "0 mm", to = "10 mm", bins = 20 }, { variable = "birthplace" }]
[[tally]]
type = "count"
name = "score"
at = "crossed"
where = [{ variable = "reach", to = "2.5 mm" }]
each = "first"
score = "reach"
)";
  const Traced traced = trace(scene, 0, with_toys());
  // Down through z = 0 after 2 mm, or reflected there (8.5 %) and up through z = 5 mm at a distance of 3 mm.
  const TallyResult& axis = traced.result.tallies.at(0);
  REQUIRE(axis.axes.size() == 2);
  CHECK(axis.axes[0].variable == "reach");
  CHECK(axis.axes[0].unit == "mm");
  CHECK(axis.axes[1].names == std::vector<std::string>{"(ambient)", "crystal"});
  const double down = axis.sum.at(4 * 2 + 1), up = axis.sum.at(6 * 2 + 1);
  CHECK(down > 70.0);
  CHECK(down + up == 100.0);
  CHECK(sum_of(axis) == 100.0);
  const TallyResult& score = traced.result.tallies.at(1);
  CHECK(score.score == "reach");
  CHECK(score.unit == "mm");
  CHECK(score.sum.at(0) == doctest::Approx(2.0 * down));
}

TEST_CASE("A variable of the direction before an event has that after all total reflections") {
  // At 25 deg to z: totally reflected at the walls, refracted at the ends by asin(1.82 sin 25 deg) - 25 deg.
  const Traced traced = trace(crystal("[0.42261826174, 0, -0.90630778704]") + R"(
[[tally]]
type = "count"
name = "turn"
at = "crossed"
axes = [{ variable = "turn", bins = 180 }]
)",
                              0, with_toys());
  const TallyResult& turned = traced.result.tallies.at(0);
  CHECK(turned.sum.at(25) == 100.0);
  CHECK(sum_of(turned) == 100.0);
}

TEST_CASE("Scenes know the variables of their own list only, and each name once") {
  const std::string tally = "[[tally]]\ntype = \"count\"\nat = \"crossed\"\nscore = \"reach\"\n";
  CHECK(contains(complaint_of([&] { scene_spec(crystal("[0, 0, 1]") + tally); }), "\"interactions\""));
  CHECK(scene_spec(crystal("[0, 0, 1]") + tally, with_toys()).tallies.at(0).score->name == "reach");
  CHECK(TallyVariables::built_in().find("reach") == nullptr);

  TallyVariables variables;
  CHECK_THROWS_AS(variables.add({.name = "time", .number = reach}), InternalError);
  CHECK_THROWS_AS(variables.add({.name = "", .number = reach}), InternalError);
  CHECK_THROWS_AS(variables.add({.name = "none"}), InternalError);
  CHECK_THROWS_AS(variables.add({.name = "both", .number = reach, .place = birthplace}), InternalError);
}
