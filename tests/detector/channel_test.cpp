// A sensor with its electronics as a whole.
#include <array>
#include <cmath>
#include <numeric>

#include "detector/made_up.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::detector;
using namespace scintray::test;

namespace {

Sensor noisy_sipm() {
  Sensor sensor = quiet_sipm(3600);
  sensor.time_spread_ns = 0.1;
  sensor.single_electron = {0.05, 0.5, 15.0};
  set_cells(sensor, &Microcells::crosstalk, 0.1);
  set_cells(sensor, &Microcells::afterpulse, 0.05);
  set_cells(sensor, &Microcells::afterpulse_time_ns, 30.0);
  sensor.dark_counts.per_ns = 0.01;
  return sensor;
}

ReadoutSpec digitizer() {
  ReadoutSpec readout;
  readout.before_ns = 50.0;
  readout.window_ns = 300.0;
  readout.noise = 0.02;
  readout.pulses = true;
  readout.photon_order = {1, 3};
  return readout;
}

std::uint64_t of(const ChannelSignal& signal, AvalancheCause cause) {
  return signal.avalanches[static_cast<std::size_t>(cause)];
}

}  // namespace

TEST_CASE("a signal holds what was requested, and the same stream has the same bits") {
  const Channel channel(noisy_sipm(), digitizer(), kFace);
  Rng first = event_stream(1), second = event_stream(1), other = event_stream(2);
  const std::vector<Arrival> arrivals = flash(40);
  const ChannelSignal a = channel.respond(arrivals, first), b = channel.respond(arrivals, second),
                      c = channel.respond(arrivals, other);
  CHECK(a.photoelectrons == 40);
  CHECK(a.waveform.size() == 300);
  CHECK(a.order_times_ns.size() == 2);
  CHECK(of(a, AvalancheCause::photon) <= 40);
  CHECK(a.waveform == b.waveform);
  CHECK(a.time_ns == b.time_ns);
  CHECK(a.waveform != c.waveform);

  ReadoutSpec without = digitizer();
  without.pulses = false;
  Rng third = event_stream(1);
  const ChannelSignal d = Channel(noisy_sipm(), without, kFace).respond(arrivals, third);
  CHECK(d.waveform.empty());
  CHECK(d.charge == a.charge);
}

TEST_CASE("without light there are dark counts, in the window only, and no photon time") {
  const Channel channel(noisy_sipm(), digitizer(), kFace);
  Moments dark;
  for (std::uint64_t event = 0; event < 2000; ++event) {
    Rng rng = event_stream(event, 1);
    const ChannelSignal signal = channel.respond({}, rng);
    CHECK(of(signal, AvalancheCause::photon) == 0);
    CHECK_FALSE(signal.first_photon_ns.has_value());
    dark.add(static_cast<double>(of(signal, AvalancheCause::dark)));
  }
  check_law("dark counts", dark.mean(), {0.01 * 300.0, 0.0});
}

TEST_CASE("dark counts before the window leave their tails in it: the mean waveform is flat from its start") {
  Sensor sensor = noisy_sipm();
  sensor.avalanches = ProportionalModel();
  sensor.single_electron.charge_spread = 0.0;
  ReadoutSpec readout = digitizer();
  readout.noise = 0.0;
  const Channel channel(sensor, readout, kFace);
  const double area_ns = PulseShape({15.0, 0.5}, 1.0).area_ns();
  Moments start, middle;
  for (std::uint64_t event = 0; event < 4000; ++event) {
    Rng rng = event_stream(event, 2);
    const ChannelSignal signal = channel.respond({}, rng);
    start.add(signal.waveform.at(0));
    middle.add(signal.waveform.at(150));
  }
  // Campbell's theorem.
  check_law("first sample", start.mean(), {0.01 * area_ns, 0.0});
  check_law("middle", middle.mean(), {0.01 * area_ns, 0.0});
}

TEST_CASE("the mean charge is the light with its crosstalk, through the electronics") {
  Sensor sensor = noisy_sipm();
  sensor.dark_counts = {};
  set_cells(sensor, &Microcells::afterpulse, 0.0);
  const Channel channel(sensor, digitizer(), kFace);
  Moments charge, causes;
  for (std::uint64_t event = 0; event < 2000; ++event) {
    Rng rng = event_stream(event, 3);
    const ChannelSignal signal = channel.respond(flash(10), rng);
    charge.add(signal.charge);
    causes.add(static_cast<double>(
        std::accumulate(signal.avalanches.begin(), signal.avalanches.end(), std::uint64_t{0})));
  }
  // The sum over samples misses the integral by 1e-3 at a nanosecond a sample, and noise has mean 0.
  check_law("charge", charge.mean(), {causes.mean().value, 1e-3 * causes.mean().value});
}

TEST_CASE("the charge is the integral over the gate, wherever between two samples the light comes") {
  // Of a pulse that begins with a step the sum of the samples is 5 % less or more, by the place of the flash.
  Sensor sensor;  // proportional, without spread
  sensor.single_electron.decay_ns = 10.0;
  ReadoutSpec readout;
  readout.before_ns = 20.0;
  readout.window_ns = 120.0;
  const auto charge_at = [&](double time_ns) {
    Rng rng = event_stream(3);
    return Channel(sensor, readout, kFace).respond(flash(1000, time_ns), rng).charge;
  };
  for (const double rise_ns : {0.0, 0.2, 3.0}) {
    sensor.single_electron.rise_ns = rise_ns;
    for (const double time_ns : {0.0, 1e-6, 0.3, 0.5, 0.999, 17.4}) {
      CAPTURE(rise_ns);
      CAPTURE(time_ns);
      // What is left of the pulse behind the last sample's period, 100 ns after the start of the event.
      const auto left = [&](double tau) { return tau * std::exp(-(100.0 - time_ns) / tau); };
      const double inside = 1.0 - (left(10.0) - (rise_ns > 0.0 ? left(rise_ns) : 0.0)) / (10.0 - rise_ns);
      CHECK(charge_at(time_ns) == doctest::Approx(1000.0 * inside).epsilon(1e-6));
    }
  }
  // A gate that cuts the pulse: from 5 to 12 ns, whole periods.
  sensor.single_electron.rise_ns = 0.0;
  readout.gate_ns = std::array{5.0, 12.0};
  CHECK(charge_at(0.4) == doctest::Approx(1000.0 * (std::exp(-0.46) - std::exp(-1.16))).epsilon(1e-6));
  CHECK(charge_at(7.25) == doctest::Approx(1000.0 * (1.0 - std::exp(-0.475))).epsilon(1e-6));
  CHECK(charge_at(12.5) == doctest::Approx(0.0));
}

TEST_CASE("a channel without a pulse shape or without a face is refused") {
  ReadoutSpec readout = digitizer();
  check_contains(complaint_of([&] { Channel(Sensor{}, readout, kFace); }), "gives a pulse a duration");
  readout.shaping_ns = {4.0, 4.0};
  CHECK(complaint_of([&] { Channel(Sensor{}, readout, kFace); }).empty());
  check_contains(complaint_of([&] { Channel(quiet_sipm(10), readout, {0.0, 0.0}); }), "no area");
  Sensor noisy = quiet_sipm(10);
  noisy.dark_counts.per_ns = 1.0;
  CHECK(complaint_of([&] { Channel(noisy, readout, kFace); }).empty());
  set_cells(noisy, &Microcells::recovery_ns, 1e6);
  check_contains(complaint_of([&] { Channel(noisy, readout, kFace); }), "dark counts in every event");
}
