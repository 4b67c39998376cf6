// Response maps traced backward from the channels, against those traced forward and closed forms.
#include <algorithm>
#include <cmath>

#include "scintray/simulation/response_map.hpp"
#include "trace/mapped.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene;
using namespace scintray::simulation;
using namespace scintray::test;

namespace {

ResponseSettings backward(double pitch_mm, std::uint64_t photons, std::uint32_t delays = 64) {
  return {pitch_mm, 1, delays, MapDirection::backward, photons};
}

/// Deviation of two maps of one scene in combined standard errors, over all cells and channels.
struct Pulls {
  double square = 0.0, largest = 0.0;
  int count = 0;
};

Pulls pulls(const ResponseMap& a, const ResponseMap& b) {
  Pulls result;
  REQUIRE(a.grids.size() == b.grids.size());
  for (std::size_t g = 0; g < a.grids.size(); ++g) {
    REQUIRE(a.grids[g].detected.size() == b.grids[g].detected.size());
    for (std::size_t i = 0; i < a.grids[g].detected.size(); ++i) {
      const std::size_t cell = i / a.channels.size();
      REQUIRE((a.grids[g].photons[cell] == 0) == (b.grids[g].photons[cell] == 0));
      if (a.grids[g].photons[cell] == 0) continue;
      const double pull = sigmas(a.grids[g].estimate(cell, i), b.grids[g].estimate(cell, i));
      result.square += pull * pull;
      result.largest = std::max(result.largest, pull);
      ++result.count;
    }
  }
  return result;
}

/// Both directions give the same map. A chi-square of k degrees exceeds k + 4 sqrt(2 k) in 1 of 1e4 correct
/// programs or less, and one of some hundred pulls exceeds 4.5 in 1 of 1e3.
void check_alike(const MappedScene& scene, const ResponseMap& forward, const ResponseMap& reversed) {
  REQUIRE(why_not_backward(scene.built.scene).empty());
  REQUIRE(reversed.backward());
  const Pulls of = pulls(forward, reversed);
  MESSAGE("chi-square " << of.square << " of " << of.count << ", largest pull " << of.largest);
  CHECK(of.square < of.count + 4.0 * std::sqrt(2.0 * of.count));
  CHECK(of.largest < 4.5);
}

/// A slab of 8 x 8 x 4 mm with four sensors below it, behind `between` (another part, or nothing).
std::string sensors_under_slab(const std::string& surface, double below_mm, const std::string& more) {
  std::string text = fmt::format(R"(
ambient = "vacuum"
[[part]]
name = "crystal"
box = ["8 mm", "8 mm", "4 mm"]
medium = "LSO_roncali2013"
surface = "{}"
[[part.face]]
name = "exit"
select = {{ normal = [0, 0, -1] }}
surface = "flat"
)",
                                 surface);
  for (const int x : {0, 1})
    for (const int y : {0, 1})
      text += fmt::format(R"(
[[part]]
name = "sensor_{0}{1}"
box = {{ low = ["{2} mm", "{3} mm", "{4} mm"], high = ["{5} mm", "{6} mm", "{7} mm"] }}
sensor = "tilted"
)",
                          x, y, 4 * x - 4, 4 * y - 4, -below_mm - 1.0, 4 * x, 4 * y, -below_mm);
  return text + placed(1) + more + R"(
[sensors.tilted]
efficiency = { definition = "internal", value = 0.4 }
window = { index = 1.5 }
[sensors.tilted.angle]
measured_in = "window"
definition = "internal"
factor = { angle = [0, 60], angle_unit = "deg", value = [1, 0.6] }
)";
}

}  // namespace

TEST_CASE("Helmholtz reciprocity: channels of a white slab see its cells alike forward and backward") {
  const MappedScene scene(sensors_under_slab("white", 0.0, ""));
  check_alike(scene, scene.map({2.0, 20'000, 8}), scene.map(backward(2.0, 60'000, 8)));
}

TEST_CASE("Helmholtz reciprocity holds through grease, gaps and a grey wrapping") {
  const MappedScene scene(sensors_under_slab("wrapped", 0.5, R"(
[[part]]
name = "grease"
box = { low = ["-4 mm", "-4 mm", "-0.5 mm"], high = ["4 mm", "4 mm", "0 mm"] }
medium = "n15"
surface = "flat"
[surfaces.wrapped]
model = "smooth"
gap = 1.0
reflectance = 0.9
specular_share = 0.3
)"));
  check_alike(scene, scene.map({2.0, 20'000, 8}), scene.map(backward(2.0, 60'000, 8)));
}

TEST_CASE("A clear cube inside sensors that convert everything: every cell has the probability 1") {
  std::string text = R"(
ambient = "vacuum"
[[part]]
name = "crystal"
box = ["3 mm", "3 mm", "3 mm"]
medium = "glowing"
surface = "flat"
[[part]]
name = "shell"
box = { low = ["-2.5 mm", "-2.5 mm", "-1 mm"], high = ["2.5 mm", "2.5 mm", "4 mm"] }
sensor = "black"
[sensors.black]
efficiency = { definition = "internal", value = 1.0 }
window = { index = "matched" }
[media.glowing]
index = { n = 1.82 }
absorption = { none = true }
scattering = { none = true }
density = { value = "7.4 g/cm3" }
composition = { formula = "Lu2SiO5" }
yield = { value = "25 1/keV" }
emission = { spectrum = { wavelength = [400, 420, 440], wavelength_unit = "nm", value = [0, 1, 0] } }
decay = [{ time = "40 ns", rise = "0 ns", fraction = 1.0 }]
)";
  const MappedScene scene(text + placed(1));
  const ResponseMap map = scene.map(backward(1.0, 200'000));
  const ResponseGrid& grid = map.grids.front();
  for (std::size_t cell = 0; cell < grid.size(); ++cell) {
    const Estimate one = grid.estimate(cell, cell);
    CAPTURE(one.value);
    CHECK(std::abs(one.value - 1.0) < 4.5 * one.error);
    CHECK(one.error < 0.02);
  }
}

TEST_CASE("Times of flight of a map traced backward have the mean of one traced forward") {
  const MappedScene scene(sensors_under_slab("white", 0.0, ""));
  const auto mean = [](const ResponseMap& map) {
    Moments times;
    for (const float delay : map.grids.front().delays_ns) times.add(double{delay});
    return times.mean();
  };
  // One cell: every kept time is a draw from the distribution of its channel.
  const Estimate forward = mean(scene.map({10.0, 40'000, 2000}));
  const Estimate reversed = mean(scene.map(backward(10.0, 40'000, 2000)));
  MESSAGE(forward.value << " +- " << forward.error << " ns forward, " << reversed.value << " +- "
                        << reversed.error << " backward");
  CHECK(sigmas(forward, reversed) < 4.5);
}

TEST_CASE("A map traced backward has the same bits for 1, 2 and 7 threads") {
  const MappedScene scene(sensors_under_slab("white", 0.0, ""));
  const ResponseMap one = scene.map(backward(2.0, 500, 8), 1);
  for (const int threads : {2, 7}) {
    const ResponseMap other = scene.map(backward(2.0, 500, 8), threads);
    CHECK(other.grids.front().probabilities == one.grids.front().probabilities);
    CHECK(other.grids.front().probability_errors == one.grids.front().probability_errors);
    CHECK(other.grids.front().delays_ns == one.grids.front().delays_ns);
  }
}

TEST_CASE(
    "Light is not traced backward through surfaces that are not reciprocal, and the reason names them") {
  const MappedScene scene(two_ends(6.0, placed(1)));
  const std::string why = why_not_backward(scene.built.scene);
  CHECK(why.find("ground") != std::string::npos);
  CHECK_THROWS_AS(scene.map(backward(2.0, 100)), InputError);
  const ResponseMap forward = scene.map({2.0, 100, 8, MapDirection::automatic, 100});
  CHECK_FALSE(forward.backward());
}

TEST_CASE("Light is not traced backward from a sensor whose efficiency depends on the place on its face") {
  // The place on a face is from its middle, which a closed surface has not: the face at the crystal is one by
  // itself.
  const std::string sensor = "sensor = \"tilted\"\n";
  std::string even = sensors_under_slab("white", 0.0, "");
  for (std::size_t at = even.find(sensor); at != std::string::npos; at = even.find(sensor, at + 1))
    even.insert(at + sensor.size(), "[[part.face]]\nname = \"window\"\nselect = { normal = [0, 0, 1] }\n");
  CHECK(why_not_backward(MappedScene(even).built.scene).empty());
  const MappedScene scene(even + R"(
[sensors.tilted.uniformity]
radial = { length = [0, 10], length_unit = "mm", value = [1, 0.4] }
)");
  CHECK(why_not_backward(scene.built.scene).find("\"tilted\"") != std::string::npos);
  CHECK_THROWS_AS(scene.map(backward(2.0, 100)), InputError);
  CHECK_FALSE(scene.map({2.0, 100, 8, MapDirection::automatic, 100}).backward());
}
