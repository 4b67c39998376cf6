#pragma once
/// A sensor with its electronics: from converted photons to the digitised signal.

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "scintray/detector/pulse.hpp"
#include "scintray/detector/readout_spec.hpp"
#include "scintray/detector/sensor.hpp"
#include "scintray/detector/sensor_response.hpp"

namespace scintray::detector {

/// Signal of one channel in one event. Times count from the start of the event.
struct ChannelSignal {
  std::uint64_t photoelectrons = 0;  ///< photons converted by the sensor
  /// Avalanches up to the end of the window, by AvalancheCause.
  std::array<std::uint64_t, kAvalancheCauses> avalanches{};
  double charge = 0.0;                    ///< integral over the gate, photoelectrons
  double amplitude = 0.0;                 ///< largest sample, photoelectrons
  std::optional<double> time_ns;          ///< of the pulse; nothing when the pulse stays below the threshold
  std::optional<double> first_photon_ns;  ///< earliest avalanche of a photon, with the sensor's time spread
  /// Times of the n-th avalanches of photons, in the order of ReadoutSpec::photon_order; nothing where there
  /// are fewer.
  std::vector<std::optional<double>> order_times_ns;
  std::vector<float> waveform;  ///< when ReadoutSpec::pulses; first sample at -before_ns
};

/// Pulse of one avalanche of a sensor after the shaper of a readout. Throws InputError (without a place) when
/// neither the sensor nor the readout defines its duration.
PulseShape pulse_of(const Sensor& sensor, const ReadoutSpec& readout);

/// A sensor and its readout. Immutable: one serves all threads. Events are independent: none affects the
/// sensor's state in the next.
class Channel {
 public:
  /// @param readout  checked as by the reader of [readout]
  /// Throws InputError (without a place) when neither the sensor nor the electronics defines the shape of
  /// pulses, when the face has no area or far too many cells, or when an event has more than 10^6 dark
  /// counts.
  Channel(const Sensor& sensor, const ReadoutSpec& readout, const SensorFace& face);

  /// @param arrivals  converted photons of one event in any order
  ChannelSignal respond(std::span<const Arrival> arrivals, core::Rng& rng) const;

 private:
  double start_ns() const { return -readout_.before_ns; }
  double end_ns() const { return start_ns() + readout_.window_ns; }

  ReadoutSpec readout_;
  PulseShape pulse_;
  SensorResponse response_;
};

}  // namespace scintray::detector
