#pragma once
/// Response of a sensor to converted photons: avalanches, each with its charge, time and cause.

#include <memory>
#include <span>
#include <vector>

#include "scintray/core/philox.hpp"
#include "scintray/detector/avalanche.hpp"
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

}  // namespace scintray::detector
