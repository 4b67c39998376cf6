// Silicon photomultipliers: saturation, recovery, dark counts, crosstalk, afterpulses.
#include <algorithm>
#include <cmath>
#include <set>

#include "detector/made_up.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::detector;
using namespace scintray::test;

namespace {

/// Middle of the face, so that no neighbour is missing.
const std::vector<Arrival> kOneInTheMiddle{{0.0, 0.001, 0.001}};

}  // namespace

TEST_CASE("Law of saturation: a flash of n photoelectrons fires N (1 - exp(-n/N)) of N cells") {
  // n is the mean of a Poisson number, for which the form is exact; Stoykov et al. 2007, JINST 2, P06005.
  constexpr std::uint32_t kCells = 400;
  const SensorResponse response(quiet_sipm(kCells), kFace);
  for (const double light : {0.1, 0.5, 1.0, 2.0, 5.0}) {
    Moments fired;
    for (std::uint64_t event = 0; event < 400; ++event) {
      Rng rng = event_stream(event);
      std::vector<Arrival> arrivals = steady_light(light * kCells, 1.0, rng);
      for (Arrival& arrival : arrivals) arrival.time_ns = 0.0;
      fired.add(total_charge(response.avalanches(arrivals, 0.0, 1.0, rng)));
    }
    check_law(fmt::format("n/N = {}", light), fired.mean(), {kCells * (1.0 - std::exp(-light)), 0.0});
  }
}

TEST_CASE("a flash on half of the face fires half of the cells at most") {
  Sensor sensor = quiet_sipm(0);
  set_cells(sensor, &Microcells::pitch_mm, 0.3);  // 10 by 10
  const SensorResponse response(sensor, kFace);
  Rng rng = event_stream(0);
  std::vector<Arrival> arrivals;
  for (int i = 0; i < 5000; ++i)
    arrivals.push_back({0.0, -1.5 + 1.5 * rng.uniform(), -1.5 + 3.0 * rng.uniform()});
  CHECK(response.avalanches(arrivals, 0.0, 1.0, rng).size() == 50);
}

TEST_CASE("a cell that fires again after dt has a charge of 1 - exp(-dt / recovery)") {
  const SensorResponse response(quiet_sipm(1), kFace);
  for (const double dt : {0.5, 5.0, 20.0, 100.0}) {
    Rng rng = event_stream(0);
    const std::vector<Arrival> twice{{dt}, {0.0}};
    const auto avalanches = response.avalanches(twice, 0.0, kLongAfter_ns, rng);
    REQUIRE(avalanches.size() == 2);
    CHECK(avalanches[0].charge == 1.0);
    CHECK(avalanches[1].charge == doctest::Approx(1.0 - std::exp(-dt / 20.0)).epsilon(1e-12));
  }
}

TEST_CASE(
    "Law of steady light: a cell that fires at rate r has 1 / (1 + r recovery) of a full charge on average") {
  const SensorResponse response(quiet_sipm(1), kFace);
  for (const double rate_times_recovery : {0.1, 1.0, 4.0}) {
    Rng rng = event_stream(0, 1);
    const double rate = rate_times_recovery / 20.0;
    const double end_ns = 20'000.0 / rate;
    const auto avalanches = response.avalanches(steady_light(rate, end_ns, rng), 0.0, end_ns, rng);
    Moments charge;
    // Successive gaps are independent, and so are successive charges.
    for (const Avalanche& avalanche : avalanches) charge.add(avalanche.charge);
    check_law(fmt::format("r recovery = {}", rate_times_recovery), charge.mean(),
              {1.0 / (1.0 + rate_times_recovery), 0.0});
  }
}

TEST_CASE(
    "Law of dark counts: rate times window, of the sensor or of its area, from the window's first ns on") {
  for (const bool by_area : {false, true}) {
    Sensor sensor = quiet_sipm(1000);
    (by_area ? sensor.dark_counts.per_ns_mm2 : sensor.dark_counts.per_ns) = 0.02;
    const double per_ns = by_area ? 0.02 * kFace.area_mm2() : 0.02;
    const SensorResponse response(sensor, kFace);
    Moments all, first_tenth;
    for (std::uint64_t event = 0; event < 1000; ++event) {
      Rng rng = event_stream(event, 2);
      std::uint64_t in_window = 0, early = 0;
      for (const Avalanche& avalanche : response.avalanches({}, -50.0, 150.0, rng)) {
        CHECK(avalanche.cause == AvalancheCause::dark);
        in_window += avalanche.time_ns >= -50.0;
        early += avalanche.time_ns >= -50.0 && avalanche.time_ns < -30.0;
      }
      all.add(static_cast<double>(in_window));
      first_tenth.add(static_cast<double>(early));
    }
    check_law(by_area ? "by area" : "of the sensor", all.mean(), {per_ns * 200.0, 0.0});
    check_law(by_area ? "by area, early" : "of the sensor, early", first_tenth.mean(), {per_ns * 20.0, 0.0});
  }
}

TEST_CASE("dark counts before the window leave cells that are not recovered") {
  Sensor sensor = quiet_sipm(1);
  sensor.dark_counts.per_ns = 0.05;  // r recovery = 1
  const SensorResponse response(sensor, kFace);
  Moments first;
  for (std::uint64_t event = 0; event < 20'000; ++event) {
    Rng rng = event_stream(event, 3);
    for (const Avalanche& avalanche : response.avalanches({}, 0.0, 200.0, rng)) {
      if (avalanche.time_ns < 0.0) continue;
      first.add(avalanche.charge);
      break;
    }
  }
  // The gap before the first count in the window is longer than others: of density r^2 t exp(-r t).
  check_law("charge", first.mean(), {0.75, 0.0});
}

TEST_CASE("Law of crosstalk: by causes and by charges, the probability of one neighbour and of exactly one") {
  for (const double probability : {0.03, 0.2, 0.5}) {
    Sensor sensor = quiet_sipm(0);
    set_cells(sensor, &Microcells::pitch_mm, 0.05);
    set_cells(sensor, &Microcells::crosstalk, probability);
    const SensorResponse response(sensor, kFace);
    constexpr std::uint64_t kEvents = 40'000;
    std::uint64_t by_cause = 0, by_charge = 0, exactly_two = 0;
    for (std::uint64_t event = 0; event < kEvents; ++event) {
      Rng rng = event_stream(event, 4);
      const auto avalanches = response.avalanches(kOneInTheMiddle, 0.0, 1.0, rng);
      by_cause += count_of(avalanches, AvalancheCause::crosstalk) > 0;
      by_charge += total_charge(avalanches) > 1.5;
      exactly_two += avalanches.size() == 2;
    }
    check_law(fmt::format("{} by cause", probability), binomial_estimate(by_cause, kEvents),
              {probability, 0.0});
    CHECK(by_charge == by_cause);
    // Gallego et al. 2013 for eight neighbours: the one that fires has seven left.
    const double q = 1.0 - std::pow(1.0 - probability, 1.0 / 8.0);
    check_law(fmt::format("{} exactly two", probability), binomial_estimate(exactly_two, kEvents),
              {8.0 * q * std::pow(1.0 - q, 14), 0.0});
  }
}

TEST_CASE("Law of crosstalk of a cell that is not recovered: 1 - (1 - p) to the power of its charge") {
  Sensor sensor = quiet_sipm(0);
  set_cells(sensor, &Microcells::pitch_mm, 0.05);
  set_cells(sensor, &Microcells::crosstalk, 0.5);
  const SensorResponse response(sensor, kFace);
  constexpr double kGap_ns = 5.0;
  const std::vector<Arrival> twice{kOneInTheMiddle[0], {kGap_ns, 0.001, 0.001}};
  constexpr std::uint64_t kEvents = 10'000;
  // Neighbours that the first has fired may fire again, with a small charge.
  std::uint64_t second = 0;
  for (std::uint64_t event = 0; event < kEvents; ++event) {
    Rng rng = event_stream(event, 7);
    const auto avalanches = response.avalanches(twice, 0.0, 10.0, rng);
    second += avalanches.back().time_ns == kGap_ns && avalanches[avalanches.size() - 2].time_ns == kGap_ns;
  }
  const double charge = 1.0 - std::exp(-kGap_ns / 20.0);
  check_law("probability", binomial_estimate(second, kEvents), {1.0 - std::pow(0.5, charge), 0.0});
}

TEST_CASE("Law of afterpulses: probability, delay, and charge tau / (tau + recovery)") {
  Sensor sensor = quiet_sipm(100);
  set_cells(sensor, &Microcells::afterpulse, 0.3);
  set_cells(sensor, &Microcells::afterpulse_time_ns, 30.0);
  const SensorResponse response(sensor, kFace);
  constexpr std::uint64_t kEvents = 40'000;
  std::uint64_t with = 0;
  Moments delay, charge;
  for (std::uint64_t event = 0; event < kEvents; ++event) {
    Rng rng = event_stream(event, 5);
    const auto avalanches = response.avalanches(flash(1), 0.0, kLongAfter_ns, rng);
    if (avalanches.size() < 2) continue;
    CHECK(avalanches[1].cause == AvalancheCause::afterpulse);
    ++with;
    delay.add(avalanches[1].time_ns);
    charge.add(avalanches[1].charge);
  }
  check_law("probability", binomial_estimate(with, kEvents), {0.3, 0.0});
  check_law("delay, ns", delay.mean(), {30.0, 0.0});
  check_law("charge of the first", charge.mean(), {30.0 / (30.0 + 20.0), 0.0});
}

TEST_CASE("an avalanche of a cell that is not recovered has as many fewer afterpulses") {
  Sensor sensor = quiet_sipm(1);
  set_cells(sensor, &Microcells::afterpulse, 0.5);
  set_cells(sensor, &Microcells::afterpulse_time_ns, 1e5);  // long after both
  const SensorResponse response(sensor, kFace);
  constexpr double kGap_ns = 10.0;
  const std::vector<Arrival> twice{{0.0}, {kGap_ns}};
  Moments after;
  for (std::uint64_t event = 0; event < 10'000; ++event) {
    Rng rng = event_stream(event, 6);
    after.add(
        static_cast<double>(count_of(response.avalanches(twice, 0.0, 2e4, rng), AvalancheCause::afterpulse)));
  }
  // Each full avalanche is followed by p / (1 - p) (1 - exp(-(1 - p) t / tau)) of its line up to t: the sum
  // over generations k of p^k times the k-fold convolution of the delay.
  const double full = 2.0 - std::exp(-kGap_ns / 20.0);
  check_law("number", after.mean(), {full * (1.0 - std::exp(-0.5 * 0.2)), 0.0});
}

TEST_CASE("the neighbours of cells are mutual, and the eight around a cell") {
  for (const std::uint32_t count : {1u, 2u, 7u, 30u, 101u}) {
    CAPTURE(count);
    const MicrocellGrid grid(Microcells{0.0, count, 20.0, 0.0, 0.0, 0.0}, {4.0, 2.0});
    REQUIRE(grid.count() == count);
    std::array<std::uint32_t, 8> buffer;
    std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
    for (std::uint32_t cell = 0; cell < count; ++cell)
      for (const std::uint32_t other : grid.neighbours(cell, buffer)) {
        CHECK(other < count);
        CHECK(other != cell);
        CHECK(pairs.emplace(cell, other).second);
      }
    for (const auto& [a, b] : pairs) CHECK(pairs.count({b, a}) == 1);
  }
  Microcells pitched;
  pitched.pitch_mm = 1.0;
  const MicrocellGrid grid(pitched, {5.0, 3.0});
  Rng rng = event_stream(0);
  CHECK(grid.at({0.0, 0.0, 0.0}, rng) == 7);
  CHECK(grid.at({0.0, -9.0, -9.0}, rng) == 0);
  CHECK(grid.at({0.0, 9.0, 9.0}, rng) == 14);
  std::array<std::uint32_t, 8> buffer;
  const auto around = grid.neighbours(7, buffer);
  CHECK(std::vector<std::uint32_t>(around.begin(), around.end()) ==
        std::vector<std::uint32_t>{1, 2, 3, 6, 8, 11, 12, 13});
}

TEST_CASE("a face without area and a pitch that is a mistake of unit are refused") {
  check_contains(complaint_of([] { SensorResponse(quiet_sipm(10), {0.0, 3.0}); }), "no area");
  Sensor sensor = quiet_sipm(0);
  set_cells(sensor, &Microcells::pitch_mm, 1e-5);
  check_contains(complaint_of([&] { SensorResponse(sensor, kFace); }), "more than 10^8 cells");
}
