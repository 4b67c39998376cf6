#include "scintray/detector/pulse.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/core/normals.hpp"

namespace scintray::detector {

namespace {

using Waveform = std::span<const float>;

double on_codes(double value, const ReadoutSpec& readout) {
  const auto [low, high] = readout.adc_range;
  const double last = std::exp2(readout.adc_bits) - 1.0;
  const double step = (high - low) / last;
  return low + step * std::clamp(std::round((value - low) / step), 0.0, last);
}

/// Sample number, not whole, at which a signal reaches a level between sample i - 1 (below) and i.
template <class Signal>
double crossing(const Signal& signal, std::size_t i, double level) {
  const double before = signal(i - 1), after = signal(i);
  return static_cast<double>(i - 1) + (level - before) / (after - before);
}

/// The first sample, not number 0, that reaches a level from below; nothing when there is none.
std::optional<std::size_t> first_rise(Waveform waveform, double level) {
  for (std::size_t i = 1; i < waveform.size(); ++i)
    if (waveform[i - 1] < level && waveform[i] >= level) return i;
  return std::nullopt;
}

std::optional<double> leading_edge(Waveform waveform, const ReadoutSpec& readout) {
  const auto rise = first_rise(waveform, readout.threshold);
  if (!rise) return std::nullopt;
  return crossing([&](std::size_t i) { return static_cast<double>(waveform[i]); }, *rise, readout.threshold);
}

std::optional<double> peak_fraction(Waveform waveform, const ReadoutSpec& readout) {
  if (!first_rise(waveform, readout.threshold)) return std::nullopt;
  const auto peak = std::max_element(waveform.begin(), waveform.end());
  const double level = readout.fraction * *peak;
  for (auto i = static_cast<std::size_t>(peak - waveform.begin()); i > 0; --i)
    if (waveform[i - 1] < level)
      return crossing([&](std::size_t at) { return static_cast<double>(waveform[at]); }, i, level);
  return std::nullopt;
}

std::optional<double> constant_fraction(Waveform waveform, const ReadoutSpec& readout) {
  const auto rise = first_rise(waveform, readout.threshold);
  if (!rise) return std::nullopt;
  const double delay = readout.delay_ns / readout.period_ns;
  const auto delayed = [&](std::size_t i) {
    const double at = static_cast<double>(i) - delay;
    if (at < 0.0) return 0.0;
    const auto before = static_cast<std::size_t>(at);
    const std::size_t after = std::min(before + 1, waveform.size() - 1);
    return std::lerp(static_cast<double>(waveform[before]), static_cast<double>(waveform[after]),
                     at - static_cast<double>(before));
  };
  const auto bipolar = [&](std::size_t i) {
    return delayed(i) - readout.fraction * static_cast<double>(waveform[i]);
  };
  std::size_t i = *rise;
  while (i > 0 && bipolar(i) >= 0.0) --i;
  for (++i; i < waveform.size(); ++i)
    if (bipolar(i - 1) < 0.0 && bipolar(i) >= 0.0) return crossing(bipolar, i, 0.0);
  return std::nullopt;
}

std::optional<double> pick_off(Waveform waveform, const ReadoutSpec& readout) {
  switch (readout.time_pickoff) {
    case TimePickoff::leading_edge:
      return leading_edge(waveform, readout);
    case TimePickoff::peak_fraction:
      return peak_fraction(waveform, readout);
    case TimePickoff::cfd:
      return constant_fraction(waveform, readout);
  }
  throw core::InternalError("unknown time pick-off");
}

/// Sum of the samples in the gate.
double gated_sum(Waveform waveform, const ReadoutSpec& readout) {
  const GateIntegral gate = gate_of(readout, waveform.size());
  double sum = 0.0;
  for (std::size_t i = gate.first; i < gate.past; ++i) sum += waveform[i];
  return sum;
}

}  // namespace

GateIntegral gate_of(const ReadoutSpec& readout, std::size_t samples) {
  if (!readout.gate_ns) return {0, samples, 0.0};
  const auto [open_ns, close_ns] = *readout.gate_ns;
  const auto before = [&](double gate_ns) {
    const auto precedes = [&](std::size_t i) {
      return static_cast<double>(i) * readout.period_ns - readout.before_ns < gate_ns;
    };
    const double about = std::floor((gate_ns + readout.before_ns) / readout.period_ns);
    auto i = static_cast<std::size_t>(std::clamp(about, 0.0, static_cast<double>(samples)));
    while (i > 0 && !precedes(i - 1)) --i;
    while (i < samples && precedes(i)) ++i;
    return i;
  };
  const std::size_t first = before(open_ns);
  return {first, std::max(first, before(close_ns)), 0.0};
}

std::vector<float> digitize(std::span<const double> waveform, const ReadoutSpec& readout, core::Rng& rng) {
  std::vector<double> noisy(waveform.size());  // of the deviates, then of the samples
  if (readout.noise > 0.0) core::sample_normals(rng, noisy);
  for (std::size_t i = 0; i < noisy.size(); ++i) noisy[i] = waveform[i] + readout.noise * noisy[i];
  if (readout.adc_bits > 0)
    for (double& sample : noisy) sample = on_codes(sample, readout);
  return {noisy.begin(), noisy.end()};
}

PulseMeasurement measure(std::span<const float> waveform, const ReadoutSpec& readout, double pulse_area_ns) {
  PulseMeasurement result;
  if (waveform.empty()) return result;
  result.charge = gated_sum(waveform, readout) * readout.period_ns / pulse_area_ns;
  result.amplitude = *std::max_element(waveform.begin(), waveform.end());
  if (const auto sample = pick_off(waveform, readout))
    result.time_ns = *sample * readout.period_ns - readout.before_ns;
  return result;
}

}  // namespace scintray::detector
