// Digitised waveforms and what is measured on them.
#include "scintray/detector/pulse.hpp"

#include <cmath>

#include "detector/made_up.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::detector;
using namespace scintray::test;

namespace {

constexpr double kBefore_ns = 10.0;

ReadoutSpec nanosecond_samples() {
  ReadoutSpec readout;
  readout.before_ns = kBefore_ns;
  readout.window_ns = 200.0;
  return readout;
}

/// One pulse of an amplitude that begins at a time, without noise.
std::vector<float> one_pulse(const PulseShape& pulse, const ReadoutSpec& readout, double charge,
                             double time_ns) {
  Rng rng = event_stream(0);
  const std::vector<Avalanche> avalanches{{time_ns, charge, AvalancheCause::photon}};
  return digitize(pulse.waveform(avalanches, -readout.before_ns, readout.samples()), readout, rng);
}

/// A ramp of `slope` per ns that begins at 20.3 ns, up to a plateau.
std::vector<float> ramp(double slope) {
  std::vector<float> samples;
  for (int i = 0; i < 100; ++i)
    samples.push_back(static_cast<float>(slope * std::clamp(i - kBefore_ns - 20.3, 0.0, 30.0)));
  return samples;
}

double time_of(const std::vector<float>& waveform, const ReadoutSpec& readout) {
  const PulseMeasurement measured = measure(waveform, readout, 1.0);
  REQUIRE(measured.time_ns.has_value());
  return *measured.time_ns;
}

}  // namespace

TEST_CASE("noise has the stated standard deviation, no mean, and no memory") {
  ReadoutSpec readout = nanosecond_samples();
  readout.noise = 0.3;
  Rng rng = event_stream(0, 1);
  const std::vector<float> samples = digitize(std::vector<double>(50'000, 2.0), readout, rng);
  Moments noise, product;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    noise.add(samples[i]);
    if (i % 2 == 1) product.add((samples[i] - 2.0) * (samples[i - 1] - 2.0));
  }
  check_law("mean", noise.mean(), {2.0, 0.0});
  check_law("standard deviation", spread_of(noise), {0.3, 0.0});
  check_law("of neighbours", product.mean(), {0.0, 0.0});
}

TEST_CASE("a converter rounds to its codes and stops at its ends") {
  ReadoutSpec readout = nanosecond_samples();
  readout.adc_bits = 4;
  readout.adc_range = {-1.0, 14.0};
  Rng rng = event_stream(0);
  const std::vector<double> exact{-5.0, -0.6, -0.4, 0.0, 3.49, 3.51, 13.9, 1000.0};
  CHECK(digitize(exact, readout, rng) == std::vector<float>{-1, -1, 0, 0, 3, 4, 14, 14});
}

TEST_CASE("the charge is the sum over the gate over the pulse's area") {
  ReadoutSpec readout = nanosecond_samples();
  readout.period_ns = 0.05;
  const PulseShape pulse({9.0, 0.7}, readout.period_ns);
  const std::vector<float> waveform = one_pulse(pulse, readout, 3.5, 4.0);
  CHECK(measure(waveform, readout, pulse.area_ns()).charge == doctest::Approx(3.5).epsilon(1e-4));
  // Up to 4 + 9 ns: the integral of the difference of exponentials.
  readout.gate_ns = {-5.0, 13.0};
  const double share = 1.0 - (9.0 * std::exp(-1.0) - 0.7 * std::exp(-9.0 / 0.7)) / 8.3;
  CHECK(measure(waveform, readout, pulse.area_ns()).charge == doctest::Approx(3.5 * share).epsilon(5e-3));
  readout.gate_ns = {-9.0, 4.0};
  CHECK(measure(waveform, readout, pulse.area_ns()).charge == doctest::Approx(0.0));
}

TEST_CASE("a gate begins and ends with the first sample that is not before its times") {
  constexpr std::size_t kSamples = 40;
  ReadoutSpec readout = nanosecond_samples();
  for (const double period_ns : {1.0, 0.3, 0.7}) {
    readout.period_ns = period_ns;
    for (const double close_ns :
         {-20.0, -10.0, 0.0, 0.1 + 0.2, 0.9, 2.1, 7.0, std::nextafter(7.0, 8.0), 300.0}) {
      CAPTURE(period_ns);
      CAPTURE(close_ns);
      readout.gate_ns = {-20.0, close_ns};
      std::size_t past = 0;
      while (past < kSamples && static_cast<double>(past) * period_ns - kBefore_ns < close_ns) ++past;
      CHECK(gate_of(readout, kSamples).first == 0);
      CHECK(gate_of(readout, kSamples).past == past);
    }
  }
}

TEST_CASE("the amplitude is the largest sample") {
  const ReadoutSpec readout = nanosecond_samples();
  const PulseShape pulse({9.0, 3.0}, readout.period_ns);
  CHECK(measure(one_pulse(pulse, readout, 7.0, 4.2), readout, 1.0).amplitude ==
        doctest::Approx(7.0).epsilon(0.01));
}

TEST_CASE("the leading edge walks with the amplitude, on a ramp by threshold over slope") {
  ReadoutSpec readout = nanosecond_samples();
  readout.threshold = 2.0;
  for (const double slope : {0.1, 1.0, 50.0}) {
    // Between two samples of a ramp there is no error but where it begins.
    const double exact = 20.3 + readout.threshold / slope;
    CHECK(time_of(ramp(slope), readout) == doctest::Approx(exact).epsilon(slope < 10.0 ? 1e-6 : 0.02));
  }
}

TEST_CASE("fraction of the peak and CFD do not depend on the amplitude; the leading edge does") {
  for (const TimePickoff pickoff :
       {TimePickoff::leading_edge, TimePickoff::peak_fraction, TimePickoff::cfd}) {
    ReadoutSpec readout = nanosecond_samples();
    readout.time_pickoff = pickoff;
    readout.threshold = 0.5;
    readout.fraction = 0.25;
    readout.delay_ns = 3.7;
    const PulseShape pulse({9.0, 3.0, 2.0}, readout.period_ns);
    const double small = time_of(one_pulse(pulse, readout, 2.0, 4.2), readout);
    const double large = time_of(one_pulse(pulse, readout, 2000.0, 4.2), readout);
    if (pickoff == TimePickoff::leading_edge)
      CHECK(small - large > 1.0);
    else
      CHECK(std::abs(small - large) < 1e-5);
    // A pulse that comes later by whole samples is found as much later.
    CHECK(time_of(one_pulse(pulse, readout, 2.0, 17.2), readout) ==
          doctest::Approx(small + 13.0).epsilon(1e-6));
  }
}

TEST_CASE("CFD on a ramp finds delay / (1 - fraction), whatever the threshold") {
  ReadoutSpec readout = nanosecond_samples();
  readout.time_pickoff = TimePickoff::cfd;
  readout.fraction = 0.2;
  readout.delay_ns = 8.0;
  for (const double threshold : {1.0, 5.0, 25.0}) {
    CAPTURE(threshold);
    readout.threshold = threshold;
    CHECK(time_of(ramp(1.0), readout) == doctest::Approx(20.3 + 8.0 / 0.8).epsilon(1e-6));
  }
}

TEST_CASE("fraction of the peak on a ramp is that share of its rise") {
  ReadoutSpec readout = nanosecond_samples();
  readout.time_pickoff = TimePickoff::peak_fraction;
  readout.fraction = 0.4;
  for (const double slope : {1.0, 30.0})
    CHECK(time_of(ramp(slope), readout) == doctest::Approx(20.3 + 0.4 * 30.0).epsilon(1e-6));
}

TEST_CASE("what stays below the threshold, or above it, has no time") {
  for (const TimePickoff pickoff :
       {TimePickoff::leading_edge, TimePickoff::peak_fraction, TimePickoff::cfd}) {
    ReadoutSpec readout = nanosecond_samples();
    readout.time_pickoff = pickoff;
    readout.threshold = 31.0;
    readout.fraction = 0.2;
    readout.delay_ns = 8.0;
    CHECK_FALSE(measure(ramp(1.0), readout, 1.0).time_ns.has_value());
    CHECK_FALSE(measure(std::vector<float>(50, 40.0F), readout, 1.0).time_ns.has_value());
    CHECK_FALSE(measure({}, readout, 1.0).time_ns.has_value());
  }
}
