// Photomultipliers: single-electron charges and transit times.
#include "detector/made_up.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::detector;
using namespace scintray::test;

TEST_CASE("a photomultiplier's charge is proportional to its light") {
  const SensorResponse response(Sensor{}, kFace);
  Rng rng = event_stream(0);
  const auto avalanches = response.avalanches(flash(12'345, 7.0), 0.0, 100.0, rng);
  CHECK(total_charge(avalanches) == 12'345.0);
  CHECK(avalanches.front().time_ns == 7.0);
  CHECK(avalanches.back().time_ns == 7.0);
}

TEST_CASE("Law of single-electron charges: mean 1, the stated spread, and a gamma's third moment") {
  for (const double spread : {0.1, 0.4, 1.0, 1.5}) {
    Sensor sensor;
    sensor.single_electron.charge_spread = spread;
    const SensorResponse response(sensor, kFace);
    Rng rng = event_stream(0, 1);
    Moments charge, square, cube;
    for (const Avalanche& avalanche : response.avalanches(flash(200'000), 0.0, 1.0, rng)) {
      charge.add(avalanche.charge);
      square.add(avalanche.charge * avalanche.charge);
      cube.add(avalanche.charge * avalanche.charge * avalanche.charge);
    }
    const double s2 = spread * spread;
    check_law(fmt::format("mean, spread {}", spread), charge.mean(), {1.0, 0.0});
    check_law(fmt::format("mean square, spread {}", spread), square.mean(), {1.0 + s2, 0.0});
    check_law(fmt::format("mean cube, spread {}", spread), cube.mean(), {(1.0 + s2) * (1.0 + 2.0 * s2), 0.0});
  }
}

TEST_CASE("Law of transit times: mean 0 and the stated standard deviation, with and without microcells") {
  for (const bool cells : {false, true}) {
    Sensor sensor = cells ? quiet_sipm(0) : Sensor{};
    if (cells) set_cells(sensor, &Microcells::pitch_mm, 0.0005);
    sensor.time_spread_ns = 0.35;
    const SensorResponse response(sensor, kFace);
    Rng rng = event_stream(0, 2);
    Moments time;
    for (const Avalanche& avalanche : response.avalanches(flash(50'000, 10.0), 0.0, 100.0, rng))
      time.add(avalanche.time_ns);
    check_law(cells ? "mean, cells" : "mean", time.mean(), {10.0, 0.0});
    check_law(cells ? "spread, cells" : "spread", spread_of(time), {0.35, 0.0});
  }
}

TEST_CASE("what comes after the end is left out, and avalanches come out by time") {
  Sensor sensor;
  sensor.time_spread_ns = 1.0;
  const SensorResponse response(sensor, kFace);
  Rng rng = event_stream(0, 3);
  const std::vector<Arrival> arrivals{{30.0}, {9.0}, {3.0}, {-40.0}, {12.0}, {1e300}};
  const auto avalanches = response.avalanches(arrivals, 0.0, 20.0, rng);
  REQUIRE(avalanches.size() == 4);
  CHECK(avalanches[0].time_ns < -30.0);
  for (std::size_t i = 1; i < avalanches.size(); ++i)
    CHECK(avalanches[i - 1].time_ns <= avalanches[i].time_ns);
  const auto at_the_end = response.avalanches(flash(10'000, 20.0), 0.0, 20.0, rng);
  check_law("half of a flash at the end", binomial_estimate(at_the_end.size(), 10'000), {0.5, 0.0});
  CHECK(at_the_end.back().time_ns < 20.0);
}
