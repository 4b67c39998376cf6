#include "scintray/detector/channel.hpp"

#include <string>

#include "scintray/core/error.hpp"

namespace scintray::detector {

namespace {

constexpr double kMostDarkCounts = 1e6;

/// Sets the numbers of avalanches and the photon times of a signal.
void count(std::span<const Avalanche> avalanches, const ReadoutSpec& readout, ChannelSignal& signal) {
  signal.order_times_ns.resize(readout.photon_order.size());
  std::uint64_t photons = 0;
  for (const Avalanche& avalanche : avalanches) {
    if (avalanche.time_ns >= -readout.before_ns)
      ++signal.avalanches[static_cast<std::size_t>(avalanche.cause)];
    if (avalanche.cause != AvalancheCause::photon) continue;
    ++photons;
    if (photons == 1) signal.first_photon_ns = avalanche.time_ns;
    for (std::size_t i = 0; i < readout.photon_order.size(); ++i)
      if (readout.photon_order[i] == photons) signal.order_times_ns[i] = avalanche.time_ns;
  }
}

}  // namespace

PulseShape pulse_of(const Sensor& sensor, const ReadoutSpec& readout) {
  std::vector<double> stages{sensor.single_electron.decay_ns, sensor.single_electron.rise_ns};
  stages.insert(stages.end(), readout.shaping_ns.begin(), readout.shaping_ns.end());
  return {stages, readout.period_ns};
}

Channel::Channel(const Sensor& sensor, const ReadoutSpec& readout, const SensorFace& face)
    : readout_(readout), pulse_(pulse_of(sensor, readout)), response_(sensor, face) {
  const double dark = response_.dark_counts(start_ns() - pulse_.duration_ns(), end_ns());
  if (dark > kMostDarkCounts)
    throw core::InputError({{},
                            "sensor \"" + sensor.name + "\" has " + std::to_string(dark) +
                                " dark counts in every event, and 10^6 is the most",
                            "check its dark count rate, its recovery time, and the window of [readout]"});
}

ChannelSignal Channel::respond(std::span<const Arrival> arrivals, core::Rng& rng) const {
  const std::vector<Avalanche> avalanches =
      response_.avalanches(arrivals, start_ns() - pulse_.duration_ns(), end_ns(), rng);
  ChannelSignal signal;
  signal.photoelectrons = arrivals.size();
  count(avalanches, readout_, signal);
  GateIntegral gate = gate_of(readout_, readout_.samples());
  const std::vector<double> exact = pulse_.waveform(avalanches, start_ns(), readout_.samples(), gate);
  std::vector<float> waveform = digitize(exact, readout_, rng);
  const PulseMeasurement measured = measure(waveform, readout_, pulse_.area_ns());
  // Noise and rounding are those of the samples; the pulses themselves count with their integral.
  double sampled = 0.0;
  for (std::size_t i = gate.first; i < gate.past; ++i) sampled += exact[i];
  signal.charge = measured.charge + (gate.integral_ns - sampled * readout_.period_ns) / pulse_.area_ns();
  signal.amplitude = measured.amplitude;
  signal.time_ns = measured.time_ns;
  if (readout_.pulses) signal.waveform = std::move(waveform);
  return signal;
}

}  // namespace scintray::detector
