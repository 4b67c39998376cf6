// Order statistics of photon times, against their exact forms.
#include <algorithm>
#include <cmath>

#include "detector/made_up.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::detector;
using namespace scintray::test;

namespace {

ReadoutSpec photon_clock(std::vector<std::uint64_t> order = {}) {
  ReadoutSpec readout;
  readout.before_ns = 10.0;
  readout.window_ns = 400.0;
  readout.shaping_ns = {5.0};
  readout.photon_order = std::move(order);
  return readout;
}

/// So many photons of an emission (exp(-t/decay) - exp(-t/rise)) / (decay - rise): a sum of two delays.
std::vector<Arrival> scintillation(std::size_t photons, double decay_ns, double rise_ns, Rng& rng) {
  std::vector<Arrival> arrivals;
  for (std::size_t i = 0; i < photons; ++i)
    arrivals.push_back({decay_ns * sample_exponential(rng) + rise_ns * sample_exponential(rng)});
  return arrivals;
}

/// Mean of the first of n times whose chance to be later than t is survival(t): its integral to the power n.
template <class Survival>
double mean_first(const Survival& survival, double n, double step_ns, double end_ns) {
  double sum = 0.0;
  for (double t = 0.5 * step_ns; t < end_ns; t += step_ns) sum += step_ns * std::pow(survival(t), n);
  return sum;
}

Estimate first_photon(const Sensor& sensor, std::size_t photons, double decay_ns, double rise_ns,
                      std::uint64_t events, std::uint64_t test) {
  const Channel channel(sensor, photon_clock(), kFace);
  Moments first;
  for (std::uint64_t event = 0; event < events; ++event) {
    Rng rng = event_stream(event, test);
    const std::vector<Arrival> arrivals = scintillation(photons, decay_ns, rise_ns, rng);
    const ChannelSignal signal = channel.respond(arrivals, rng);
    REQUIRE(signal.first_photon_ns.has_value());
    first.add(*signal.first_photon_ns);
  }
  return first.mean();
}

}  // namespace

TEST_CASE("Law of the first photon: tau / N without rise time") {
  for (const std::size_t photons : {10u, 100u, 1000u})
    check_law(fmt::format("N = {}, ns", photons), first_photon(Sensor{}, photons, 40.0, 0.0, 1000, 1),
              {40.0 / static_cast<double>(photons), 0.0});
}

TEST_CASE("Law of the n-th photon: tau (1/N + ... + 1/(N - n + 1))") {
  const std::vector<std::uint64_t> order{1, 5, 20, 101};
  const Channel channel(Sensor{}, photon_clock(order), kFace);
  std::array<Moments, 3> times;
  for (std::uint64_t event = 0; event < 1000; ++event) {
    Rng rng = event_stream(event, 2);
    const std::vector<Arrival> arrivals = scintillation(100, 40.0, 0.0, rng);
    const ChannelSignal signal = channel.respond(arrivals, rng);
    REQUIRE(signal.order_times_ns.size() == order.size());
    CHECK(signal.order_times_ns[0] == signal.first_photon_ns);
    CHECK_FALSE(signal.order_times_ns[3].has_value());
    for (std::size_t i = 0; i < times.size(); ++i) times[i].add(signal.order_times_ns[i].value_or(-1.0));
  }
  for (std::size_t i = 0; i < times.size(); ++i) {
    double exact = 0.0;
    for (std::uint64_t k = 0; k < order[i]; ++k) exact += 40.0 / static_cast<double>(100 - k);
    check_law(fmt::format("n = {}, ns", order[i]), times[i].mean(), {exact, 0.0});
  }
}

TEST_CASE("Law of the first photon with a rise time: the integral of the survival to the power N") {
  constexpr double kDecay = 40.0, kRise = 0.5;
  const auto survival = [](double t) {
    return (kDecay * std::exp(-t / kDecay) - kRise * std::exp(-t / kRise)) / (kDecay - kRise);
  };
  for (const std::size_t photons : {50u, 2000u}) {
    const double exact = mean_first(survival, static_cast<double>(photons), 1e-4, 20.0);
    check_law(fmt::format("N = {}, ns", photons), first_photon(Sensor{}, photons, kDecay, kRise, 500, 3),
              {exact, 0.0});
  }
  // Where the first photon comes well within the rise, N >> decay / rise, the emission is t / (rise decay)
  // and the mean sqrt(pi rise decay / (2 N)); the next term is smaller by about the mean over the rise.
  for (const double photons : {1e4, 1e5, 1e6}) {
    const double form = std::sqrt(0.5 * kPi * kRise * kDecay / photons);
    const double exact = mean_first(survival, photons, 1e-5, 2.0);
    CAPTURE(photons);
    CHECK(std::abs(exact / form - 1.0) < form / kRise);
    CHECK(exact > form);
  }
}

TEST_CASE("Law of the first photon of a flash: the least of N normal transit times") {
  Sensor sensor;
  sensor.time_spread_ns = 0.3;
  const auto survival = [](double t) { return 0.5 * std::erfc((t - 5.0) / (0.3 * std::sqrt(2.0))); };
  const Channel channel(sensor, photon_clock(), kFace);
  Moments first;
  for (std::uint64_t event = 0; event < 1000; ++event) {
    Rng rng = event_stream(event, 4);
    first.add(channel.respond(flash(100, 5.0), rng).first_photon_ns.value_or(0.0));
  }
  check_law("N = 100, ns", first.mean(), {mean_first(survival, 100.0, 1e-4, 10.0), 0.0});
}
