// Efficiency over the face of a sensor.
#include <cmath>
#include <fstream>

#include "physics/traced.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::tally;
using namespace scintray::test;

namespace {

const std::string kUneven = R"(
ambient = "vacuum_n1"
[sensors.uneven]
efficiency = { definition = "internal", value = 0.5 }
window = { index = 1.0 }
)";

const std::string kWindow = "[[part.face]]\nname = \"window\"\nselect = { normal = [0, 0, 1] }\n";

/// A sensor with a face of 20 mm x 10 mm at z = 0, its middle at (5, 0) mm.
std::string sensor_part(const std::string& more = "") {
  return R"(
[[part]]
name = "tube"
box = { low = ["-5 mm", "-5 mm", "-2 mm"], high = ["15 mm", "5 mm", "0 mm"] }
sensor = "uneven"
)" + more +
         kWindow;
}

std::string beam_at(double x_mm, double y_mm) {
  return fmt::format(
      "[source]\ntype = \"photons\"\nposition = [\"{} mm\", \"{} mm\", \"1 mm\"]\ndirection = [0, 0, "
      "-1]\nwavelength = \"420 nm\"\nphotons = 20_000\n",
      x_mm, y_mm);
}

const std::string kRadial =
    "uniformity = { radial = { length = [0, 10], length_unit = \"mm\", value = [1, 0.4] } }\n";

std::string uneven_grid() {
  const auto path = scratch_folder("face_response") / "map.csv";
  std::ofstream(path) << "x,y,factor\n-10,-5,0\n10,-5,1\n-10,5,1\n10,5,2\n";
  return "uniformity = { map = { file = \"" + path.string() + "\", unit = \"mm\" } }\n";
}

double mean_factor(const Traced& traced, const std::string& face) {
  const scene::Scene& scene = traced.built.scene;
  for (const FaceId id : scene.faces.ids())
    if (scene.faces[id].name == face) return scene.sensor_frames[id].mean_factor;
  FAIL("no such face");
  return 0.0;
}

}  // namespace

TEST_CASE("Law of a radial face response: efficiency times the factor at the distance from the middle") {
  for (const auto& [x, y] : {std::pair{5.0, 0.0}, std::pair{8.0, 4.0}, std::pair{-3.0, -3.0}}) {
    const double radius = std::hypot(x - 5.0, y);
    const Traced traced = trace(kUneven + kRadial + sensor_part() + beam_at(x, y));
    check_law(fmt::format("radius {:.3g} mm", radius), traced.result.fraction(Fate::detected),
              {0.5 * (1.0 - 0.06 * radius), 0.0});
  }
}

TEST_CASE("Law of a face response on a grid: bilinear, along the axes of the part") {
  const std::string grid = uneven_grid();
  const auto factor = [](double x, double y) { return 1.0 + x / 20.0 + y / 10.0; };  // from the middle
  for (const auto& [x, y] : {std::pair{5.0, 0.0}, std::pair{12.0, 3.0}, std::pair{-4.0, 2.0}}) {
    const Traced traced = trace(kUneven + grid + sensor_part() + beam_at(x, y));
    check_law(fmt::format("({:g}, {:g}) mm", x - 5.0, y), traced.result.fraction(Fate::detected),
              {0.5 * factor(x - 5.0, y), 0.0});
    CHECK(mean_factor(traced, "tube:window") == doctest::Approx(1.0).epsilon(1e-6));
  }
  // Turned by 90 deg about z and about its own origin: the part's x lies along y, its y along -x.
  const std::string turned = sensor_part("rotate = { axis = [0, 0, 1], angle = \"90 deg\" }\n");
  const Traced traced = trace(kUneven + grid + turned + beam_at(-2.0, 9.0));
  check_law("turned", traced.result.fraction(Fate::detected), {0.5 * factor(9.0 - 5.0, 2.0), 0.0});
}

TEST_CASE("Photons that no place of a sensor would convert are left out, and the detected stay the same") {
  const std::string scene = kUneven + uneven_grid() + sensor_part() + beam_at(12.0, 3.0);
  const Traced all = trace(scene + "[run]\nefficiency_at_birth = false\n"), some = trace(scene);
  CHECK(some.result.birth_efficiency == 1.0);  // 0.5 times the greatest factor, 2
  CHECK(some.result.count(Fate::detected) == all.result.count(Fate::detected));
  const Traced radial = trace(kUneven + kRadial + sensor_part() + beam_at(12.0, 3.0));
  const Traced radial_all =
      trace(kUneven + kRadial + sensor_part() + beam_at(12.0, 3.0) + "[run]\nefficiency_at_birth = false\n");
  CHECK(radial.result.birth_efficiency == 0.5);
  CHECK(radial.result.photons < radial_all.result.photons);
  CHECK(radial.result.count(Fate::detected) == radial_all.result.count(Fate::detected));
}

TEST_CASE("The mean of a radial factor over a square face is its integral") {
  // Of a square of side 2 a the mean distance from the middle is a (sqrt(2) + ln(1 + sqrt(2))) / 3.
  const std::string square = R"(
[[part]]
name = "tube"
box = { low = ["-5 mm", "-5 mm", "-2 mm"], high = ["5 mm", "5 mm", "0 mm"] }
sensor = "uneven"
)" + kWindow;
  const double mean_radius = 5.0 * (std::sqrt(2.0) + std::log(1.0 + std::sqrt(2.0))) / 3.0;
  CHECK(mean_factor(trace(kUneven + kRadial + square + beam_at(0.0, 0.0)), "tube:window") ==
        doctest::Approx(1.0 - 0.06 * mean_radius).epsilon(1e-4));
}

TEST_CASE("A face response needs a face with a direction") {
  std::string found;
  try {
    trace(
        kUneven + kRadial +
        "[[part]]\nname = \"ball\"\nsphere = { radius = \"2 mm\", subdivisions = 4 }\nsensor = \"uneven\"\n" +
        beam_at(0.0, 0.0));
  } catch (const InputError& error) {
    found = error.what();
  }
  CHECK(found.find("is a closed surface, which has no middle") != std::string::npos);
}
