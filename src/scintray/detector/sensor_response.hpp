#pragma once
/// What a sensor makes of converted photons: avalanches, each with its charge, time and cause.

#include <memory>
#include <span>
#include <vector>

#include "scintray/core/philox.hpp"
#include "scintray/detector/avalanche.hpp"
#include "scintray/detector/sensor.hpp"

namespace scintray::detector {

/// Carriers fire avalanches as the sensor's model has it. Each then has a charge of the model's mean and of
/// relative spread SingleElectron::charge_spread, gamma distributed (the Polya limit: J. R. Prescott 1966,
/// Nucl. Instrum. Methods 39, 173), after a normal transit time.
///
/// Immutable: no event leaves anything behind for the next one.
class SensorResponse {
 public:
  /// Throws InputError (without a place) when the face does not suit the sensor's model.
  SensorResponse(const Sensor& sensor, const SensorFace& face);

  /// Avalanches sorted by time. Work grows as n log n with their number.
  /// @param arrivals  any order, any time
  /// @param start_ns, end_ns  dark counts are right between these; what happens later is left out
  std::vector<Avalanche> avalanches(std::span<const Arrival> arrivals, double start_ns, double end_ns,
                                    core::Rng& rng) const;
  /// Mean number of dark counts that are made for such an event, those before its start among them.
  double dark_counts(double start_ns, double end_ns) const;

 private:
  double time_spread_ns_, charge_spread_, dark_per_ns_;
  std::shared_ptr<const AvalancheProcess> process_;
  double memory_ns_;
};

}  // namespace scintray::detector
