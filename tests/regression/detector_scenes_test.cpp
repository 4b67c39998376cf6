/// The detector scenes against the answers in their own headers, with another seed.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <regex>
#include <sstream>

#include "bad_input/marked_text.hpp"
#include "scintray/simulation/simulation.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::config;
using namespace scintray::optics;
using namespace scintray::scene_file;
using namespace scintray::scene;
using namespace scintray::tally;
using namespace scintray::simulation;
using test::replaced;

namespace {

using Answers = std::map<std::string, Estimate>;

/// The lines "#   NAME = VALUE ± ERROR" of a scene's header.
Answers answers_in(const std::string& text) {
  Answers answers;
  const std::regex line(R"(#\s+(\S.*\S) = (-?[\d.]+) ± ([\d.]+).*)");
  std::istringstream lines(text);
  for (std::string at; std::getline(lines, at);) {
    std::smatch found;
    if (std::regex_match(at, found, line)) answers[found[1]] = {std::stod(found[2]), std::stod(found[3])};
  }
  return answers;
}

struct Detector {
  RunResult result;
  Scene scene;  ///< of the first point
};

/// Runs a scene of scenes/ after a change of its text.
Detector run(const std::string& name, const std::string& text, std::uint64_t photons, std::uint64_t seed) {
  const SceneFile file = SceneFile::from_text(text, test::source_file("scenes/" + name).string());
  SimulationOptions options;
  options.photons = photons;
  options.seed = seed;
  Simulation simulation(file, options);
  const auto first = simulation.point(0);
  return {simulation.run_all(), first->scene()};
}

std::string scene_text(const std::string& name) {
  return read_text_file(test::source_file("scenes/" + name));
}

/// Middle and width of the light on the sensors along an axis, each photon counted at the middle of the
/// sensor that detected it: Anger's centre of gravity (H. O. Anger 1958, Rev. Sci. Instrum. 29, 27).
struct Light {
  Estimate centre_mm;
  double width_mm = 0.0;  ///< standard deviation
  std::uint64_t photons = 0;
};
Light light_on_sensors(const Detector& detector, std::size_t point, int axis) {
  double n = 0.0, sum = 0.0, squares = 0.0;
  for (const SensorFaceCount& count : detector.result.points[point].sensor_faces) {
    const std::string& name = detector.result.header.parts[count.part];
    for (const PartInfo& part : detector.scene.parts) {
      if (part.name != name) continue;
      const double x = part.bounds.center()[axis], w = static_cast<double>(count.detected);
      n += w;
      sum += w * x;
      squares += w * x * x;
    }
  }
  const double mean = sum / n, width = std::sqrt(squares / n - mean * mean);
  return {{mean, width / std::sqrt(n)}, width, static_cast<std::uint64_t>(n)};
}

/// Seeds differ, so both are independent; a true answer fails once in 15,800 comparisons.
void check_answers(const Answers& measured, const Answers& stated) {
  for (const auto& answer : measured)
    MESSAGE(fmt::format("#   {} = {:.4g} ± {:.2g}", answer.first, answer.second.value, answer.second.error));
  CHECK(measured.size() == stated.size());
  for (const auto& answer : measured) {
    const auto& name = answer.first;
    const auto& value = answer.second;
    CAPTURE(name);
    REQUIRE(stated.count(name) == 1);
    CAPTURE(value.value);
    CHECK(sigmas(value, stated.at(name)) < 4.0);
  }
}

std::string position_of(const std::string& crystal) { return "x of " + crystal + ", mm"; }

}  // namespace

TEST_CASE("12 x 12 block: the flood map separates a whole row, in order and mirrored") {
  const std::string text = scene_text("block_detector.toml");
  const Detector detector =
      run("block_detector.toml", replaced(text, "\"crystal[*]\"", "\"crystal[*,5]\""), 40'000, 20);
  Answers measured;
  std::vector<Light> row;
  for (std::size_t i = 0; i < 12; ++i) {
    row.push_back(light_on_sensors(detector, i, 0));
    measured[position_of("crystal[" + std::to_string(i) + ",5]")] = row.back().centre_mm;
  }
  const Answers stated = answers_in(text);
  check_answers(measured, stated);
  // Of one event: as many photons as a gamma of 511 keV makes, 12,775.
  const auto event_sigma = [&](const Light& light) {
    return light.width_mm / std::sqrt(static_cast<double>(light.photons) * 12775.0 / 40'000.0);
  };
  // Distances are those of the scene's own numbers, with which the run agrees. The run itself has a tenth of
  // their photons: its error of a distance is as large as what the nearest crystals at the edge have to
  // spare.
  for (std::size_t i = 0; i + 1 < row.size(); ++i) {
    CAPTURE(i);
    const auto centre = [&](std::size_t crystal) {
      return stated.at(position_of("crystal[" + std::to_string(crystal) + ",5]")).value;
    };
    const double distance = centre(i + 1) - centre(i);
    CHECK(distance > 2.0 * 2.355 * event_sigma(row[i]));  // two full widths at half maximum
  }
  for (std::size_t i = 0; i + 1 < row.size(); ++i)
    CHECK(row[i + 1].centre_mm.value - row[i].centre_mm.value > 0.0);
  for (std::size_t i = 0; i < 6; ++i) {
    const Estimate& left = row[i].centre_mm;
    const Estimate right{-row[11 - i].centre_mm.value, row[11 - i].centre_mm.error};
    CHECK(sigmas(left, right) < 4.0);
  }
}

TEST_CASE("Staggered double layer: crystals of the upper layer lie between those of the lower one") {
  const std::string text = scene_text("doi_block.toml");
  const Detector detector = run("doi_block.toml", text, 40'000, 20);
  Answers measured;
  std::vector<double> lower, upper;
  for (std::size_t i = 0; i < 15; ++i) {
    const Light light = light_on_sensors(detector, i, 0);
    measured[position_of(detector.result.points[i].parameters[0])] = light.centre_mm;
    (i < 8 ? lower : upper).push_back(light.centre_mm.value);
  }
  check_answers(measured, answers_in(text));
  for (std::size_t i = 0; i < upper.size(); ++i) {
    CAPTURE(i);
    CHECK(upper[i] > lower[i]);
    CHECK(upper[i] < lower[i + 1]);
  }
}

TEST_CASE("Dual-ended readout: the asymmetry of both ends falls steadily with depth, and is odd") {
  const std::string text = scene_text("dual_ended.toml");
  const Detector detector = run("dual_ended.toml", text, 60'000, 20);
  Answers measured;
  std::vector<Estimate> asymmetry;
  for (const PointResult& point : detector.result.points) {
    double below = 0.0, above = 0.0;
    for (const SensorFaceCount& count : point.sensor_faces)
      (detector.result.header.parts[count.part] == "below" ? below : above) +=
          static_cast<double>(count.detected);
    const double share = below / (below + above);
    asymmetry.push_back({2.0 * share - 1.0, 2.0 * std::sqrt(share * (1.0 - share) / (below + above))});
    measured["asymmetry at " + point.parameters[0]] = asymmetry.back();
    measured["detected at " + point.parameters[0]] = point.fraction(Fate::detected);
  }
  check_answers(measured, answers_in(text));
  for (std::size_t i = 0; i < 5; ++i) {
    CAPTURE(i);
    if (i > 0) CHECK(asymmetry[i].value < asymmetry[i - 1].value);
    CHECK(sigmas(asymmetry[i], {-asymmetry[4 - i].value, asymmetry[4 - i].error}) < 4.0);
  }
}

TEST_CASE("Phosphor on the far half: light from greater depth arrives later, and more of it is shifted") {
  const std::string text = scene_text("phosphor_coated.toml");
  const Detector detector = run("phosphor_coated.toml", text, 20'000, 20);
  Answers measured;
  std::vector<double> time_ns, shifted;
  for (const PointResult& point : detector.result.points) {
    const std::vector<double>& colour = point.tallies.at(0).sum;
    const std::uint64_t detected = point.count(Fate::detected);
    const Estimate share = binomial_estimate(detected - static_cast<std::uint64_t>(colour[0]), detected);
    measured["mean time at " + point.parameters[0] + ", ns"] = point.detected_time_ns.mean();
    measured["shifted at " + point.parameters[0]] = share;
    time_ns.push_back(point.detected_time_ns.mean().value);
    shifted.push_back(share.value);
    // Every photon that the phosphor kept was absorbed at a surface.
    const ShiftCount count = point.shifted();
    CHECK(count.absorbed > count.emitted);
    CHECK(count.absorbed - count.emitted < point.count(Fate::absorbed_at_surface));
  }
  check_answers(measured, answers_in(text));
  CHECK(time_ns.back() > time_ns.front() + 10.0);
  CHECK(shifted.back() > shifted.front());
}

TEST_CASE("Monolithic slab: the centre of gravity follows the source, and lags behind towards the edge") {
  const std::string text = scene_text("monolithic_slab.toml");
  const Detector detector = run("monolithic_slab.toml", text, 40'000, 20);
  Answers measured;
  std::vector<Estimate> x;
  for (std::size_t i = 0; i < detector.result.points.size(); ++i) {
    x.push_back(light_on_sensors(detector, i, 0).centre_mm);
    measured["centre of light from x = " + detector.result.points[i].parameters[0]] = x.back();
  }
  check_answers(measured, answers_in(text));
  CHECK(sigmas(x[2], {0.0, 0.0}) < 4.0);
  CHECK(sigmas(x[1], {-x[4].value, x[4].error}) < 4.0);
  CHECK(sigmas(x[0], {-x[6].value, x[6].error}) < 4.0);
  for (std::size_t i = 1; i < x.size(); ++i) CHECK(x[i].value > x[i - 1].value);
  CHECK(x[7].value < 0.9 * 24.0);
}
