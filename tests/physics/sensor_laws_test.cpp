// Share of light incident on a sensor at an angle that is converted, by tracing.
#include <cmath>

#include "physics/traced.hpp"
#include "scintray/optics/fresnel.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::test;

namespace {

struct Beam {
  double angle_deg = 0.0;   ///< to the sensor's normal
  std::string ambient;      ///< medium it comes through
  std::string definition;   ///< of efficiency (0.3) and angle
  std::string measured_in;  ///< the angle
};

/// Share of a beam's photons that a sensor with a window of index 1.5 detects. Its factor falls from 1 to
/// 0.5 at 80 deg, linearly.
Estimate detected(const Beam& beam) {
  const double angle = beam.angle_deg * kDegree;
  const std::string reference = beam.definition == "external" ? "reference_index = 1.0" : "";
  const std::string angle_reference =
      beam.definition == "external" || beam.measured_in == "outside" ? "reference_index = 1.0" : "";
  const Traced traced = trace(fmt::format(R"(
ambient = "{}"
[[part]]
name = "sensor"
box = ["20 mm", "20 mm", "1 mm"]
sensor = "turned"
[source]
type = "photons"
position = ["0 mm", "0 mm", "2 mm"]
direction = [{}, 0, {}]
wavelength = "420 nm"
photons = 40000
[sensors.turned]
window = {{ index = 1.5 }}
[sensors.turned.efficiency]
value = 0.3
definition = "{}"
{}
[sensors.turned.angle]
factor = {{ angle = [0, 80], angle_unit = "deg", value = [1, 0.5] }}
measured_in = "{}"
definition = "{}"
{}
)",
                                          beam.ambient, std::sin(angle), -std::cos(angle), beam.definition,
                                          reference, beam.measured_in, beam.definition, angle_reference));
  return traced.result.fraction(Fate::detected);
}

double factor(double angle_rad) { return 1.0 - 0.5 * angle_rad / (80.0 * kDegree); }

}  // namespace

TEST_CASE(
    "Law of external efficiency: the published share is detected at each angle, with one Fresnel loss") {
  for (const double angle_deg : {0.0, 30.0, 60.0, 75.0})
    check_law(fmt::format("{} deg in air", angle_deg),
              detected({angle_deg, "vacuum_n1", "external", "outside"}),
              {0.3 * factor(angle_deg * kDegree), 0.0});
}

TEST_CASE(
    "Law of internal efficiency: the light that has entered, times the factor at the angle in the window") {
  for (const double angle_deg : {0.0, 60.0}) {
    const double cosine = std::cos(angle_deg * kDegree);
    const double inside = std::asin(std::sin(angle_deg * kDegree) / 1.5);
    const double entering = 1.0 - fresnel(cosine, 1.0, 1.5).unpolarised();
    check_law(fmt::format("{} deg in air", angle_deg),
              detected({angle_deg, "vacuum_n1", "internal", "window"}),
              {0.3 * entering * factor(inside), 0.0});
    check_law(fmt::format("{} deg in index 1.5", angle_deg),
              detected({angle_deg, "n15", "internal", "window"}), {0.3 * factor(angle_deg * kDegree), 0.0});
  }
}

namespace {

/// A clear crystal of 10 x 10 x 1 mm whose light starts towards its exit end, directions uniform over the
/// hemisphere, and a sensor there; each photon interacts once at most.
std::string towards_sensor(const std::string& sensor, const std::string& contact = "") {
  return R"(
ambient = "vacuum_n1"
[[part]]
name = "crystal"
box = { low = ["-500 mm", "-500 mm", "0 mm"], high = ["500 mm", "500 mm", "1 mm"] }
medium = "lso_clear"
surface = "flat"
[[part]]
name = "eye"
box = { low = ["-500 mm", "-500 mm", "-1 mm"], high = ["500 mm", "500 mm", "0 mm"] }
)" + sensor +
         R"(
[source]
type = "photons"
position = ["0 mm", "0 mm", "0.5 mm"]
direction = { lambertian = [0, 0, -1] }
wavelength = "420 nm"
photons = 60_000
[run]
max_interactions = 1
)" + contact;
}

}  // namespace

TEST_CASE("Law of a matched window: all light that reaches the sensor enters it, at every angle") {
  const std::string matched =
      "\n[sensors.half]\nefficiency = { definition = \"internal\", value = 0.5 }\nwindow = { index = "
      "\"matched\" }\n";
  const Traced ideal = trace(towards_sensor("sensor = \"ideal\""));
  CHECK(ideal.result.count(Fate::detected) == ideal.result.photons);
  check_law("half of it",
            trace(towards_sensor("sensor = \"half\"") + matched).result.fraction(Fate::detected), {0.5, 0.0});
  // With a window of its own it reflects: 1 - R of Lambertian light, 1.82 to 1.5.
  const Traced window = trace(towards_sensor("sensor = \"mine\"") +
                              "\n[sensors.mine]\nbase = \"ideal\"\nwindow = { index = 1.5 }\n");
  double entering = 0.0;
  constexpr int kSteps = 20'000;
  for (int i = 0; i < kSteps; ++i)  // uniform in the squared sine
    entering += (1.0 - fresnel(std::sqrt((i + 0.5) / kSteps), 1.82, 1.5).unpolarised()) / kSteps;
  check_law("with a window of 1.5", window.result.fraction(Fate::detected), {entering, 0.0});
}

TEST_CASE("Law of a dry contact with an opaque part or a matched sensor: light enters it from the gap") {
  // From the crystal into the gap of index 1 by Fresnel's equations, and from there without reflection.
  double entering = 0.0;
  constexpr int kSteps = 20'000;
  for (int i = 0; i < kSteps; ++i)
    entering += (1.0 - fresnel(std::sqrt((i + 0.5) / kSteps), 1.82, 1.0).unpolarised()) / kSteps;
  const std::string dry = "[[contact]]\nbetween = [\"crystal\", \"eye\"]\nkind = \"dry\"\n";
  const Traced sensor = trace(towards_sensor("sensor = \"ideal\"", dry));
  check_law("matched sensor", sensor.result.fraction(Fate::detected), {entering, 0.0});
  const Traced opaque = trace(towards_sensor("medium = \"opaque\"\nsurface = \"flat\"", dry));
  check_law("opaque part", opaque.result.fraction(Fate::absorbed_in_medium), {entering, 0.0});
}

TEST_CASE("Law of a glued sensor: an efficiency published in air holds at the same index times sine") {
  // In index 1.5, 30 deg is what 48.6 deg is in air; nothing in air is 60 deg, so the last value holds.
  const double in_air = std::asin(1.5 * std::sin(30.0 * kDegree));
  check_law("30 deg", detected({30.0, "n15", "internal", "outside"}), {0.3 * factor(in_air), 0.0});
  check_law("60 deg", detected({60.0, "n15", "internal", "outside"}), {0.3 * 0.5, 0.0});
  const auto entering = [](double cosine) { return 1.0 - fresnel(cosine, 1.0, 1.5).unpolarised(); };
  check_law("30 deg, external", detected({30.0, "n15", "external", "outside"}),
            {0.3 * factor(in_air) / entering(std::cos(in_air)), 0.0});
}
