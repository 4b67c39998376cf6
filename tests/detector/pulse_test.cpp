// Pulses against their closed forms, and waveforms as sums of pulses.
#include <cmath>

#include "detector/made_up.hpp"
#include "scintray/detector/pulse.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::detector;
using namespace scintray::test;

namespace {

constexpr double kRounding = 1e-12;

double cr_rc(double t, int order, double tau) {
  return std::pow(t / tau, order) * std::exp(-t / tau) / (std::tgamma(order + 1.0) * tau);
}

double two_exponentials(double t, double decay, double rise) {
  return (std::exp(-t / decay) - std::exp(-t / rise)) / (decay - rise);
}

/// Compares with a density of area 1 on a grid that is not that of the samples.
template <class Form>
void check_form(const PulseShape& pulse, const Form& form) {
  for (double t = 0.0; t < 200.0; t += 0.37) {
    CAPTURE(t);
    CHECK(std::abs(pulse.value(t) - pulse.area_ns() * form(t)) < kRounding);
  }
  CHECK(pulse.value(-1e-9) == 0.0);
}

}  // namespace

TEST_CASE("one stage is an exponential with peak 1") {
  const PulseShape pulse({5.0}, 1.0);
  CHECK(pulse.area_ns() == doctest::Approx(5.0).epsilon(kRounding));
  check_form(pulse, [](double t) { return std::exp(-t / 5.0) / 5.0; });
}

TEST_CASE("two stages are a difference of exponentials whose peak is where it must be") {
  const double decay = 9.0, rise = 0.7;
  const PulseShape pulse({decay, rise}, 1.0);
  check_form(pulse, [&](double t) { return two_exponentials(t, decay, rise); });
  const double peak_ns = std::log(decay / rise) * decay * rise / (decay - rise);
  CHECK(pulse.value(peak_ns) == doctest::Approx(1.0).epsilon(kRounding));
  CHECK(pulse.area_ns() == doctest::Approx(1.0 / two_exponentials(peak_ns, decay, rise)).epsilon(kRounding));
}

TEST_CASE("CR-RC^n peaks at n time constants") {
  for (const int order : {1, 2, 3, 4, 5, 10}) {
    const double tau = 3.0;
    const PulseShape pulse(std::vector<double>(static_cast<std::size_t>(order) + 1, tau), 1.0);
    check_form(pulse, [&](double t) { return cr_rc(t, order, tau); });
    CHECK(pulse.value(order * tau) == doctest::Approx(1.0).epsilon(kRounding));
  }
}

TEST_CASE("a sensor's pulse behind a shaper is their convolution") {
  // exp(-t/a)/a through a CR-RC shaper: by partial fractions, b the shaper's time constant.
  const double a = 12.0, b = 2.0;
  const PulseShape pulse({a, b, b}, 0.5);
  check_form(pulse, [&](double t) {
    const double k = a / (a - b);
    return k * k * (std::exp(-t / a) - std::exp(-t / b)) / a - k * t * std::exp(-t / b) / (b * b) * (b / a);
  });
}

TEST_CASE("time constants that are nearly equal, and far apart, are exact") {
  const PulseShape nearly({3.0, 3.0 * (1.0 + 1e-9), 3.0 * (1.0 - 1e-9)}, 1.0);
  for (double t = 0.1; t < 60.0; t += 1.7)
    CHECK(nearly.value(t) == doctest::Approx(nearly.area_ns() * cr_rc(t, 2, 3.0)).epsilon(1e-8));
  const PulseShape apart({1000.0, 0.001}, 1.0);
  for (double t = 0.0005; t < 5000.0; t *= 3.0)
    CHECK(apart.value(t) ==
          doctest::Approx(apart.area_ns() * two_exponentials(t, 1000.0, 0.001)).epsilon(1e-10));
}

TEST_CASE("the area is the integral, and what is left after the duration is less than 1e-4 of it") {
  for (const std::vector<double>& stages :
       {std::vector{5.0}, {9.0, 0.7}, {3.0, 3.0, 3.0, 3.0, 3.0}, {20.0, 4.0, 4.0}}) {
    const PulseShape pulse(stages, 1.0);
    constexpr double kStep = 0.025;
    double sum = 0.0, late = 0.0;
    for (double t = 0.5 * kStep; t < 400.0; t += kStep) {
      sum += kStep * pulse.value(t);
      if (t > pulse.duration_ns()) late += kStep * pulse.value(t);
    }
    CHECK(sum == doctest::Approx(pulse.area_ns()).epsilon(1e-5));
    CHECK(late < 1e-4 * sum);
  }
}

TEST_CASE("a waveform is the sum of its avalanches' pulses, at every sample") {
  Rng rng = event_stream(0);
  std::vector<Avalanche> avalanches;
  for (double t = -60.0; t < 90.0; t += 5.0 * sample_exponential(rng))
    avalanches.push_back({t, 0.2 + rng.uniform(), AvalancheCause::photon});
  avalanches.push_back({100.0, 3.0, AvalancheCause::photon});  // on a sample
  const double start_ns = -20.0;
  for (const std::vector<double>& stages :
       {std::vector{9.0}, {9.0, 0.7, 2.0, 2.0}, {9.0, 0.7, 2.0, 2.0, 2.0, 2.0, 2.0, 1.0}}) {
    CAPTURE(stages.size());
    const PulseShape pulse(stages, 0.8);
    const std::vector<double> waveform = pulse.waveform(avalanches, start_ns, 200);
    REQUIRE(waveform.size() == 200);
    for (std::size_t i = 0; i < waveform.size(); ++i) {
      const double t = start_ns + 0.8 * static_cast<double>(i);
      double sum = 0.0;
      for (const Avalanche& avalanche : avalanches)
        sum += avalanche.charge * pulse.value(t - avalanche.time_ns);
      CAPTURE(i);
      CHECK(std::abs(waveform[i] - sum) < 1e-11);
    }
  }
}

TEST_CASE("avalanches too early to matter are passed over") {
  const PulseShape pulse({5.0, 1.0}, 1.0);
  const std::vector<Avalanche> avalanches{{-1e12, 1.0, AvalancheCause::photon},
                                          {3.0, 1.0, AvalancheCause::photon}};
  const std::vector<double> waveform = pulse.waveform(avalanches, 0.0, 50);
  for (std::size_t i = 0; i < waveform.size(); ++i)
    CHECK(waveform[i] == doctest::Approx(pulse.value(static_cast<double>(i) - 3.0)).epsilon(1e-9));
}

TEST_CASE("a pulse without duration is refused with the keys to set") {
  const std::string said = complaint_of([] { PulseShape({0.0, 1e-6}, 1.0); });
  check_contains(said, "neither the sensor nor the electronics gives a pulse a duration");
  check_contains(said, "[readout] shaping");
}

TEST_CASE("a pulse is exact to its end however long it is, up to a million samples") {
  const PulseShape pulse({20'000.0, 0.001}, 1.0);
  for (const double t : {0.01, 77.7, 5'000.25, 150'000.5})
    CHECK(pulse.value(t) ==
          doctest::Approx(pulse.area_ns() * two_exponentials(t, 20'000.0, 0.001)).epsilon(1e-9));
  check_contains(complaint_of([] { PulseShape({1e9, 1.0}, 1.0); }), "more than 10^6 samples");
}
