#pragma once
/// A sensor with its electronics: converted photons in, what a digitiser gives out.

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "scintray/detector/pulse.hpp"
#include "scintray/detector/readout_spec.hpp"
#include "scintray/detector/sensor.hpp"
#include "scintray/detector/sensor_response.hpp"

namespace scintray::detector {

/// What one channel states of one event. Times count from the start of the event.
struct ChannelSignal {
  std::uint64_t photoelectrons = 0;  ///< photons that the sensor converted
  /// Avalanches up to the end of the window, by AvalancheCause.
  std::array<std::uint64_t, kAvalancheCauses> avalanches{};
  double charge = 0.0;                    ///< over the gate, photoelectrons
  double amplitude = 0.0;                 ///< largest sample, photoelectrons
  std::optional<double> time_ns;          ///< of the pulse; nothing when it stays below the threshold
  std::optional<double> first_photon_ns;  ///< earliest avalanche of a photon, with the sensor's time spread
  /// The n-th of these, in the order of ReadoutSpec::photon_order; nothing where there are fewer.
  std::vector<std::optional<double>> order_times_ns;
  std::vector<float> waveform;  ///< when ReadoutSpec::pulses; first sample at -before_ns
};

/// The pulse of one avalanche of a sensor behind a readout. Throws InputError (without a place) when neither
/// of them gives it a duration.
PulseShape pulse_of(const Sensor& sensor, const ReadoutSpec& readout);

/// Immutable, so one serves all threads. No event leaves anything behind in the sensor for the next one.
class Channel {
 public:
  /// @param readout  as the reader of [readout] checks it
  /// Throws InputError (without a place) when neither the sensor nor the electronics gives pulses a shape,
  /// when the face has no area or far too many cells, or when an event has more than 10^6 dark counts.
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
