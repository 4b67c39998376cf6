// Photons that no sensor would convert are not traced: the detected ones are the same to the last bit, and
// the fates of all follow from the others.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

#include "scenes.hpp"
#include "scintray/simulation/memory_sink.hpp"
#include "scintray/simulation/results_file.hpp"
#include "scintray/simulation/simulation.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::tally;
using namespace scintray::simulation;
using namespace scintray::test;

namespace {

const std::string kTraceAll = "[run]\nphoton_list = true\nefficiency_at_birth = false\n";
const std::string kTraceSome = "[run]\nphoton_list = true\n";

MemorySink run_of(const std::string& text) {
  MemorySink sink;
  Simulation(scene_of(text)).run_all(sink);
  return sink;
}

const PointResult& only_point(const MemorySink& sink) {
  REQUIRE(sink.result.points.size() == 1);
  return sink.result.points[0];
}

void check_same_detected(const MemorySink& some, const MemorySink& all) {
  const PointResult &a = only_point(some), &b = only_point(all);
  CHECK(a.emitted == b.emitted);
  CHECK(a.count(Fate::detected) == b.count(Fate::detected));
  CHECK(a.detected_time_ns.sum == b.detected_time_ns.sum);
  CHECK(a.detected_path_histogram == b.detected_path_histogram);
  REQUIRE(some.photon_list.size() == all.photon_list.size());
  REQUIRE(!some.photon_list.empty());
  for (std::size_t i = 0; i < some.photon_list.size(); ++i) {
    CHECK(some.photon_list[i].photon == all.photon_list[i].photon);
    CHECK(some.photon_list[i].event == all.photon_list[i].event);
    CHECK(some.photon_list[i].position_mm == all.photon_list[i].position_mm);
    CHECK(some.photon_list[i].time_ns == all.photon_list[i].time_ns);
  }
}

}  // namespace

TEST_CASE("A run that traces only what a sensor could convert detects the same photons") {
  const MemorySink some = run_of(kCrystal + kPhotons + kTraceSome);
  const MemorySink all = run_of(kCrystal + kPhotons + kTraceAll);
  check_same_detected(some, all);
  const PointResult &part = only_point(some), &whole = only_point(all);
  CHECK(whole.birth_efficiency == 1.0);
  CHECK(whole.photons == 3'000);
  // R6231 converts 0.2 to 0.35 of blue light at best.
  CHECK(part.birth_efficiency > 0.2);
  CHECK(part.birth_efficiency < 0.4);
  // Binomial: 5 standard deviations are exceeded by one seed in two million.
  const double expected = 3'000 * part.birth_efficiency;
  CHECK(std::abs(static_cast<double>(part.photons) - expected) <
        5.0 * std::sqrt(expected * (1.0 - part.birth_efficiency)));
  CHECK(part.segments < whole.segments / 2);
  CHECK(part.lost == 0);
}

TEST_CASE("Events of energy with few photons traced have the same signals") {
  const MemorySink some = run_of(kCrystal + kEvents + kTraceSome);
  const MemorySink all = run_of(kCrystal + kEvents + kTraceAll);
  check_same_detected(some, all);
  REQUIRE(some.event_list.size() == all.event_list.size());
  for (std::size_t i = 0; i < some.event_list.size(); ++i) {
    CHECK(some.event_list[i].emitted == all.event_list[i].emitted);
    CHECK(some.event_list[i].detected == all.event_list[i].detected);
  }
  CHECK(only_point(some).energy.detected.sum == only_point(all).energy.detected.sum);
}

TEST_CASE("Fates of all photons follow from those traced, and their errors are right") {
  // 300 runs of 1,000 photons against one of 300,000 of which all are traced. Per fate of a twentieth or more
  // of the photons the mean deviation is compared with its error, and the mean square with the mean of the
  // reported variances: its relative standard error is sqrt((2 + k) / runs), the excess kurtosis k of a share
  // of 300 traced photons being under 0.1. 4.5 standard errors are exceeded by one seed in 150,000.
  const auto photons = [](int number, bool every) {
    return kCrystal + R"(
[source]
type = "photons"
region = { part = "crystal" }
wavelength = "emission"
photons = )" +
           std::to_string(number) + "\n[run]\nefficiency_at_birth = " + (every ? "false" : "true") + "\n";
  };
  constexpr int kRuns = 300;
  SimulationOptions options;
  options.seed = 1000;
  const PointResult reference = Simulation(scene_of(photons(300'000, true)), options).run(0);
  std::array<double, kFateCount> sum{}, squares{}, variances{};
  const scene_file::SceneFile scene = scene_of(photons(1'000, false));
  for (int i = 0; i < kRuns; ++i) {
    options.seed = static_cast<std::uint64_t>(i) + 1;
    const PointResult result = Simulation(scene, options).run(0);
    double all = 0.0;
    for (std::size_t fate = 0; fate < kFateCount; ++fate) {
      const Estimate share = result.fraction(fate_at(static_cast<int>(fate)));
      const double deviation = share.value - reference.fraction(fate_at(static_cast<int>(fate))).value;
      all += share.value;
      sum[fate] += deviation;
      squares[fate] += deviation * deviation;
      variances[fate] += share.error * share.error;
    }
    CHECK(all == doctest::Approx(1.0).epsilon(1e-12));
  }
  int compared = 0;
  for (std::size_t fate = 0; fate < kFateCount; ++fate) {
    const Estimate expected = reference.fraction(fate_at(static_cast<int>(fate)));
    if (expected.value < 0.05) continue;
    ++compared;
    CAPTURE(fate_name(fate_at(static_cast<int>(fate))));
    const double error = std::hypot(std::sqrt(variances[fate]) / kRuns, expected.error);
    CHECK(std::abs(sum[fate] / kRuns) < 4.5 * error);
    CHECK(std::abs(squares[fate] / variances[fate] - 1.0) < 4.5 * std::sqrt(2.1 / kRuns));
  }
  CHECK(compared >= 3);
}

TEST_CASE(
    "Every photon is traced where a tally counts others than the detected, and where a sensor is ideal") {
  const auto birth_efficiency = [](const std::string& text) {
    return Simulation(scene_of(text)).point(0)->settings().birth_efficiency;
  };
  const std::string count = "[[tally]]\ntype = \"count\"\nname = \"seen\"\nat = \"";
  CHECK(birth_efficiency(kCrystal + kPhotons) < 1.0);
  CHECK(birth_efficiency(kCrystal + kPhotons + count + "detected\"\nfate = \"detected\"\n") < 1.0);
  CHECK(birth_efficiency(kCrystal + kPhotons + count + "detected\"\n") < 1.0);
  CHECK(birth_efficiency(kCrystal + kPhotons + count + "escaped\"\n") == 1.0);
  CHECK(birth_efficiency(kCrystal + kPhotons + "[run]\nphoton_history = true\n") == 1.0);
  std::string ideal = kCrystal + kPhotons;
  ideal.replace(ideal.find("R6231"), 5, "ideal");
  CHECK(birth_efficiency(ideal) == 1.0);
}

TEST_CASE("A tally of detected photons has the same sums, and a result keeps how many were traced") {
  const std::string tally = R"(
[[tally]]
type = "count"
name = "late"
at = "detected"
fate = "detected"
axes = [{ of = "time", bins = 20, from = "0 ns", to = "200 ns" }]
)";
  const PointResult some = only_point(run_of(kCrystal + kPhotons + tally + kTraceSome));
  const PointResult all = only_point(run_of(kCrystal + kPhotons + tally + kTraceAll));
  CHECK(some.birth_efficiency < 1.0);
  CHECK(some.tallies.at(0).sum == all.tallies.at(0).sum);
  CHECK(some.tallies.at(0).per_photon(2, some.emitted).value ==
        all.tallies.at(0).per_photon(2, all.emitted).value);

  const auto path = scratch_folder("efficiency_at_birth") / "some.h5";
  ResultsFile file(path);
  Simulation(scene_of(kCrystal + kPhotons + kTraceSome)).run_all(file);
  const RunResult read = results::read_results(path);
  CHECK(read.points[0].birth_efficiency == some.birth_efficiency);
  CHECK(read.points[0].emitted == 3'000);
  CHECK(read.points[0].photons == some.photons);
}

TEST_CASE(
    "A photon of the run has the same end when it is replayed; one that was not traced is not detected") {
  const Simulation simulation(scene_of(kCrystal + kPhotons + kTraceSome));
  const MemorySink all = run_of(kCrystal + kPhotons + kTraceAll);
  const auto point = Simulation(scene_of(kCrystal + kPhotons + kTraceSome)).point(0);
  std::vector<bool> detected(3'000);
  for (const DetectedPhoton& photon : all.photon_list) detected[photon.event * 100 + photon.photon] = true;
  int not_traced = 0;
  for (std::uint64_t i = 0; i < 600; ++i) {
    StepEvent last = StepEvent::escaped;
    const auto visit = [&](const source::Photon&, const transport::Step& step) { last = step.event; };
    const source::Photon end = point->replay(i / 100, i % 100, visit);
    CHECK((last == StepEvent::detected) == detected[i]);
    not_traced += end.conversion_draw >= point->settings().birth_efficiency ? 1 : 0;
  }
  CHECK(not_traced > 300);
}
