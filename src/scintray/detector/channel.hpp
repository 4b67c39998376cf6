#pragma once
/// A sensor with its electronics: from converted photons to the digitised signal.

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "scintray/core/rng.hpp"
#include "scintray/detector/avalanche.hpp"
#include "scintray/detector/pulse.hpp"
#include "scintray/detector/readout_spec.hpp"
#include "scintray/detector/sensor.hpp"

namespace scintray::detector {

/// Response of one sensor: its model generates avalanches from carriers. The charge of each has the model's
/// mean and the relative spread SingleElectron::charge_spread, gamma distributed (the Polya limit: J. R.
/// Prescott 1966, Nucl. Instrum. Methods 39, 173); its transit time is normally distributed.
///
/// Immutable; events are independent.
class SensorResponse {
 public:
  /// Throws InputError (without a place) when the sensor's model cannot be applied to the face.
  SensorResponse(const Sensor& sensor, const SensorFace& face);

  /// Avalanches sorted by time, in n log n operations for n of them.
  /// @param arrivals  any order, any time
  /// @param start_ns, end_ns  interval in which dark counts are complete; later avalanches are omitted
  std::vector<Avalanche> avalanches(std::span<const Arrival> arrivals, double start_ns, double end_ns,
                                    core::Rng& rng) const;
  /// Mean number of dark counts generated for such an event, those before its start included.
  double dark_counts(double start_ns, double end_ns) const;

 private:
  double time_spread_ns_, charge_spread_, dark_per_ns_;
  std::shared_ptr<const AvalancheProcess> process_;
  double memory_ns_;
};

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
