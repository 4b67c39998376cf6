// Counts: what is counted, under which conditions, into which bin.
#include <doctest/doctest.h>

#include <numeric>

#include "physics/traced.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::tally;
using namespace scintray::test;

namespace {

/// A beam along z from a point of the left of two blocks of index 1 that share the plane x = 0, onto a
/// detector under both.
const std::string kTwoBlocks = R"(
ambient = "vacuum_n1"
[[part]]
name = "left"
box = { low = ["-2 mm", "-1 mm", "0 mm"], high = ["0 mm", "1 mm", "4 mm"] }
medium = "vacuum_n1"
surface = "flat"
[[part.face]]
name = "exit"
select = { normal = [0, 0, -1] }
[[part]]
name = "right"
box = { low = ["0 mm", "-1 mm", "0 mm"], high = ["2 mm", "1 mm", "4 mm"] }
medium = "vacuum_n1"
surface = "flat"
[[part.face]]
name = "exit"
select = { normal = [0, 0, -1] }
[[part]]
name = "eye"
box = { low = ["-2 mm", "-1 mm", "-1 mm"], high = ["2 mm", "1 mm", "0 mm"] }
medium = "vacuum_n1"
sensor = "perfect_n1"
)";

std::string beam(const std::string& place, const std::string& direction, int photons = 100) {
  return fmt::format(
      "[source]\ntype = \"photons\"\nposition = {}\ndirection = {}\nwavelength = \"500 nm\"\nphotons = {}\n",
      place, direction, photons);
}

const std::string kIsotropic = R"(
[source]
type = "photons"
region = { part = "left" }
wavelength = "500 nm"
photons = 20_000
)";

double total(const TallyResult& tally) { return std::accumulate(tally.sum.begin(), tally.sum.end(), 0.0); }

const TallyResult& tally_of(const Traced& traced, std::size_t i = 0) { return traced.result.tallies.at(i); }

std::vector<Problem> scene_problems(const std::string& text) {
  return problems_of([&] { trace(text); });
}

}  // namespace

TEST_CASE("A beam falls into the pixel, the time, the path and the angle of the geometry") {
  // From (-1.5, 0.5, 3) along (3, 0, -4)/5: reaches z = 0 at x = 0.75 after 3.75 mm, crossing x = 0.
  const Traced traced = trace(kTwoBlocks + beam(R"(["-1.5 mm", "0.5 mm", "3 mm"])", "[3, 0, -4]") + R"(
[[tally]]
type = "light_spread"
face = ["left:exit", "right:exit"]
pixels = [16, 4]
[[tally]]
type = "count"
name = "time, path, angle"
at = "detected"
face = "right:exit"
axes = [{ variable = "time", from = "0 ns", to = "0.1 ns", bins = 100 },
        { variable = "path", from = "0 mm", to = "10 mm", bins = 10 },
        { variable = "angle_before", bins = 90 },
        { variable = "crossings", from = 0, to = 4, bins = 4 }]
[[tally]]
type = "count"
name = "through the left exit"
at = "detected"
face = "left:exit"
[[tally]]
type = "count"
name = "path"
at = "detected"
score = "path"
)");
  const TallyResult& spread = tally_of(traced);
  REQUIRE(spread.axes[0].bins() == 16);
  CHECK(spread.axes[0].edges.front() == -2.0);
  CHECK(spread.axes[1].edges.back() == 1.0);
  CHECK(spread.sum[11 * 4 + 3] == 100.0);  // x in 0.75 to 1, y in 0.5 to 1
  CHECK(total(spread) == 100.0);

  const TallyResult& fine = tally_of(traced, 1);
  // 3.75 mm / c = 0.012509 ns; the angle is acos(0.8) = 36.87 deg; two regions changed.
  CHECK(fine.sum[((12 * 10 + 3) * 90 + 36) * 4 + 2] == 100.0);
  CHECK(total(tally_of(traced, 2)) == 0.0);
  const TallyResult& path = tally_of(traced, 3);
  CHECK(path.unit == "mm");
  CHECK(path.per_photon(0, 100).value == doctest::Approx(3.75));
  CHECK(path.per_photon(0, 100).error == doctest::Approx(0.0).epsilon(1e-6));
}

TEST_CASE("Tallies know the sides of a box, and its other face is then what is left of it") {
  // Straight down from the middle of the left block, out of its named face and into the eye's top.
  const Traced traced = trace(kTwoBlocks + beam(R"(["-1.5 mm", "0.5 mm", "3 mm"])", "[0, 0, -1]") + R"(
[[tally]]
type = "count"
name = "top"
at = "detected"
face = "eye:+z"
way = "in"
[[tally]]
type = "count"
name = "rest"
at = "detected"
face = "eye:other"
way = "in"
[[tally]]
type = "exit_angle"
face = "left:+x"
)");
  CHECK(total(tally_of(traced, 0)) == 100.0);
  CHECK(total(tally_of(traced, 1)) == 0.0);
  CHECK(total(tally_of(traced, 2)) == 0.0);
  // A rule has the triangles of its side, whatever its name.
  const std::vector<Problem> found =
      scene_problems(kTwoBlocks + beam(R"(["-1.5 mm", "0.5 mm", "3 mm"])", "[0, 0, -1]") +
                     "[[tally]]\ntype = \"count\"\nname = \"taken\"\nat = \"crossed\"\nface = \"left:-z\"\n");
  REQUIRE(found.size() == 1);
  check_contains(found[0].what, {"no face", "left:-z"});
  check_contains(found[0].hint, "there are: left:exit");
}

TEST_CASE("Conditions keep the photons they describe and no others") {
  const Traced traced = trace(kTwoBlocks + kIsotropic + R"(
[[tally]]
type = "count"
name = "all"
at = ["detected", "unconverted"]
axes = [{ variable = "part" }]
[[tally]]
type = "count"
name = "by way of the right"
at = "detected"
visited = "right"
[[tally]]
type = "count"
name = "never on the right"
at = "detected"
not_visited = "right"
[[tally]]
type = "count"
name = "from the left"
at = "detected"
source_part = "le*"
[[tally]]
type = "count"
name = "late"
at = "detected"
where = [{ variable = "path", from = "2 mm" }]
[[tally]]
type = "count"
name = "early"
at = "detected"
where = [{ variable = "path", to = "2 mm" }]
[[tally]]
type = "count"
name = "crossings of those that escaped"
at = "crossed"
face = "left:other"
fate = "escaped"
[[tally]]
type = "count"
name = "ends"
at = ["detected", "escaped"]
axes = [{ variable = "occasion" }]
)");
  const double detected = static_cast<double>(traced.result.count(Fate::detected));
  const double escaped = static_cast<double>(traced.result.count(Fate::escaped));
  CHECK(detected > 1000.0);
  CHECK(total(tally_of(traced, 0)) == detected);
  CHECK(tally_of(traced, 0).axes[0].names == std::vector<std::string>{"eye"});
  CHECK(total(tally_of(traced, 1)) > 100.0);
  CHECK(total(tally_of(traced, 1)) + total(tally_of(traced, 2)) == detected);
  CHECK(total(tally_of(traced, 3)) == detected);
  CHECK(total(tally_of(traced, 4)) > 100.0);
  CHECK(total(tally_of(traced, 4)) + total(tally_of(traced, 5)) == detected);
  // In index 1 throughout, who escapes left once by a side or the top, and did so by the left or the right.
  CHECK(total(tally_of(traced, 6)) > 0.5 * escaped);
  CHECK(total(tally_of(traced, 6)) < escaped + 1.0);
  CHECK(tally_of(traced, 7).sum == std::vector<double>{detected, escaped});
}

TEST_CASE("A ledger has the light that a sensor reflects, counted from the sensor's own side") {
  const Traced traced = trace(R"(
ambient = "vacuum_n1"
[[part]]
name = "crystal"
box = ["4 mm", "4 mm", "5 mm"]
medium = "lso_clear"
surface = "flat"
[[part]]
name = "detector"
box = ["4 mm", "4 mm", "1 mm"]
place = { touch = "crystal", side = "-z" }
sensor = "perfect"
[source]
type = "photons"
position = ["0 mm", "0 mm", "2.5 mm"]
direction = { cone = [0, 0, -1], half_angle = "0.1 deg" }
wavelength = "420 nm"
photons = 40_000
[run]
max_interactions = 1
[[tally]]
type = "ledger"
)");
  const TallyResult& ledger = tally_of(traced);
  REQUIRE(ledger.axes[0].names == std::vector<std::string>{"crystal:other", "detector:other"});
  const std::size_t sensor = ledger.axes[1].bins();
  const auto at = [&](std::size_t face, const char* event) {
    const auto& names = ledger.axes[1].names;
    const auto found = std::find(names.begin(), names.end(), event);
    REQUIRE(found != names.end());
    return ledger.sum[face * sensor + static_cast<std::size_t>(found - names.begin())];
  };
  CHECK(at(1, "detected") == static_cast<double>(traced.result.count(Fate::detected)));
  CHECK(at(1, "detected") + at(1, "returned") == 40'000.0);
  CHECK(at(0, "returned") == at(1, "returned"));  // the same light, seen from the crystal
  const double fresnel = std::pow((1.82 - 1.5) / (1.82 + 1.5), 2);
  check_law("reflected", binomial_estimate(static_cast<std::uint64_t>(at(1, "returned")), 40'000),
            {fresnel, 0.0});
}

TEST_CASE("The ledger of faces accounts for every interaction, and each first and last once a photon") {
  const Traced traced = trace(R"(
ambient = "vacuum_n1"
[[part]]
name = "crystal"
box = ["2 mm", "2 mm", "5 mm"]
medium = "lso"
surface = "flat"
[[part.face]]
name = "exit"
select = { normal = [0, 0, -1] }
[[part]]
name = "detector"
box = ["2 mm", "2 mm", "1 mm"]
place = { touch = "crystal", side = "-z" }
medium = "n15"
sensor = "perfect"
[source]
type = "photons"
region = { part = "crystal" }
wavelength = "420 nm"
photons = 5000
[run]
max_interactions = 1000
[[tally]]
type = "ledger"
face = "crystal:*"
[[tally]]
type = "count"
name = "first return"
at = "returned"
each = "first"
[[tally]]
type = "count"
name = "last return"
at = "returned"
each = "last"
[[tally]]
type = "count"
name = "returned at all"
at = "returned"
axes = [{ variable = "interactions", from = 0, to = 1100, bins = 1 }]
)");
  const PointResult& result = traced.result;
  const TallyResult& ledger = tally_of(traced);
  REQUIRE(ledger.axes[0].names == std::vector<std::string>{"crystal:exit", "crystal:other"});
  REQUIRE(ledger.axes[1].names.size() == 6);
  CHECK(total(ledger) == result.interactions.sum);
  CHECK(ledger.sum[2] == static_cast<double>(result.count(Fate::detected)));  // detected at the exit
  CHECK(ledger.sum[6 + 2] == 0.0);                                            // and nowhere else
  CHECK(ledger.sum[6 + 1] == static_cast<double>(result.count(Fate::escaped)));
  // Errors are those of sums of what each photon gave, far beyond those of single counts.
  CHECK(ledger.sum_of_squares[6] > 10.0 * ledger.sum[6]);
  CHECK(total(tally_of(traced, 1)) == total(tally_of(traced, 2)));
  CHECK(total(tally_of(traced, 1)) < 5000.0);
  CHECK(total(tally_of(traced, 3)) > total(tally_of(traced, 1)));
}

TEST_CASE("Scores beyond the axes are counted as such") {
  const Traced traced = trace(kTwoBlocks + beam(R"(["-1 mm", "0 mm", "1 mm"])", "[0, 0, -1]") + R"(
[[tally]]
type = "count"
name = "path"
at = "detected"
axes = [{ variable = "path", from = "2 mm", to = "3 mm", bins = 2 }]
)");
  CHECK(total(tally_of(traced)) == 0.0);
  CHECK(tally_of(traced).outside == 100.0);
}

TEST_CASE("An axis ends where the scene says, and holds what lies on the ends of its variable") {
  const Traced slanted = trace(kTwoBlocks + beam(R"(["-1.5 mm", "0.5 mm", "3 mm"])", "[3, 0, -4]") + R"(
[[tally]]
type = "count"
name = "36.87 deg"
at = "detected"
face = "right:exit"
axes = [{ variable = "angle_before", from = "40 deg", to = "90 deg", bins = 5 }]
)");
  CHECK(total(tally_of(slanted)) == 0.0);
  CHECK(tally_of(slanted).outside == 100.0);

  const Traced straight = trace(kTwoBlocks + beam(R"(["-1 mm", "0 mm", "1 mm"])", "[0, 0, -1]") + R"(
[[tally]]
type = "count"
name = "cosine 1"
at = "detected"
axes = [{ variable = "direction", along = [0, 0, -1], bins = 4 }]
)");
  CHECK(tally_of(straight).sum == std::vector<double>{0.0, 0.0, 0.0, 100.0});
}

TEST_CASE("Counts are the same to the bit for any number of threads") {
  const std::string scene = kTwoBlocks + kIsotropic + R"(
[[tally]]
type = "count"
name = "time of arrival"
at = "detected"
score = "time"
axes = [{ variable = "position", along = [1, 0, 0], from = "-2 mm", to = "2 mm", bins = 7 }]
)";
  const TallyResult one = trace(scene, 1).result.tallies.at(0), seven = trace(scene, 7).result.tallies.at(0);
  CHECK(one.sum == seven.sum);
  CHECK(one.sum_of_squares == seven.sum_of_squares);
}

TEST_CASE("Light of all parts that a pattern names is uniform over their volume") {
  std::string scene = kTwoBlocks + kIsotropic + "[[tally]]\ntype = \"crosstalk\"\nname = \"x\"\n";
  scene.replace(scene.find("\"left\" }"), 8, "\"*t\" }");
  const Traced traced = trace(scene);
  const TallyResult& emitted = tally_of(traced, 0);
  REQUIRE(emitted.axes[0].names == std::vector<std::string>{"left", "right"});
  CHECK(total(emitted) == 20'000.0);
  CHECK(sigmas({emitted.sum[0], std::sqrt(20'000.0) / 2.0}, {10'000.0, 0.0}) < kSigmas);
  CHECK(total(tally_of(traced, 1)) == static_cast<double>(traced.result.count(Fate::detected)));
}

TEST_CASE("Impossible tallies are refused with the possible names") {
  const auto refused = [&](const std::string& tally) {
    const std::vector<Problem> found = scene_problems(kTwoBlocks + kIsotropic + "[[tally]]\n" + tally);
    std::string text;
    for (const Problem& problem : found) {
      CHECK(problem.where.line > 0);
      text += problem.text() + "\n";
    }
    return text;
  };
  CHECK(contains(refused("type = \"crosstalks\"\n"), "crosstalk"));
  CHECK(contains(refused("type = \"irradiance\"\nface = \"left:exot\"\npixels = [2, 2]\n"),
                 "did you mean \"left:exit\"?"));
  CHECK(contains(refused("type = \"irradiance\"\nface = \"left:other\"\npixels = [2, 2]\n"), "is not flat"));
  CHECK(contains(refused("type = \"irradiance\"\nface = \"left:exit\"\n"), "pixels"));
  CHECK(contains(refused("type = \"irradiance\"\nface = \"left:exit\"\npixel = \"1 nm\"\n"), "coarser axes"));
  CHECK(contains(refused("type = \"count\"\n"), "add at = \"detected\""));
  CHECK(contains(refused("type = \"count\"\nat = \"detekted\"\n"), "did you mean \"detected\"?"));
  CHECK(contains(refused("type = \"count\"\nat = \"escaped\"\nface = \"left:exit\"\n"),
                 "does not happen at faces"));
  CHECK(contains(
      refused("type = \"count\"\nat = \"detected\"\naxes = [{ variable = \"angle_after\", bins = 3 }]\n"),
      "needs a face"));
  CHECK(contains(refused("type = \"count\"\nat = \"detected\"\naxes = [{ variable = \"time\", bins = 3 }]\n"),
                 "needs both its ends"));
  CHECK(contains(
      refused("type = \"count\"\nat = \"detected\"\naxes = [{ variable = \"position\", from = \"0 mm\", "
              "to = \"1 mm\", bins = 3 }]\n"),
      "add along"));
  CHECK(contains(refused("type = \"count\"\nat = \"detected\"\nvisited = \"middle\"\n"),
                 "no part is called \"middle\""));
  CHECK(contains(refused("type = \"count\"\nat = \"detected\"\nwhere = [{ variable = \"time\" }]\n"),
                 "without bounds"));
}
