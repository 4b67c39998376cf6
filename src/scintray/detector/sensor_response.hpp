#pragma once
/// What a sensor makes of converted photons: avalanches, each with its charge, time and cause.

#include <optional>
#include <span>
#include <vector>

#include "scintray/core/philox.hpp"
#include "scintray/detector/avalanche.hpp"
#include "scintray/detector/microcell_grid.hpp"
#include "scintray/detector/sensor.hpp"

namespace scintray::detector {

/// Photomultipliers: every photoelectron gives a charge of mean 1 and relative spread
/// SingleElectron::charge_spread, gamma distributed (the Polya limit: J. R. Prescott 1966, Nucl. Instrum.
/// Methods 39, 173), after a normal transit time.
///
/// Silicon photomultipliers: every carrier fires its cell. The charge is 1 - exp(-dt / recovery), dt since
/// the cell fired last, times the same spread. Each neighbour of eight fires at once with the probability q
/// that makes 1 - (1 - q)^8 the crosstalk (L. Gallego et al. 2013, JINST 8, P05013), neighbours of
/// neighbours too; cells at the edge have fewer. The cell fires once more after an exponential delay with
/// the probability of afterpulses. In a cell that is not recovered both are reduced as its charge is: 1 - q
/// to the power of the charge, and the probability of afterpulses times it.
///
/// Immutable: an event begins with a rested sensor, except for dark counts of the time before.
class SensorResponse {
 public:
  /// Throws InputError when the face has no area or more cells than 10^8.
  SensorResponse(const Sensor& sensor, const SensorFace& face);

  /// Avalanches sorted by time. Work grows as n log n with their number.
  /// @param arrivals  any order, any time
  /// @param start_ns, end_ns  dark counts are right between these; what happens later is left out
  std::vector<Avalanche> avalanches(std::span<const Arrival> arrivals, double start_ns, double end_ns,
                                    core::Rng& rng) const;
  /// Mean number of dark counts that are made for such an event, those before its start among them.
  double dark_counts(double start_ns, double end_ns) const;

 private:
  double time_spread_ns_, charge_spread_, dark_per_ns_, memory_ns_;
  std::optional<Microcells> microcells_;
  std::optional<MicrocellGrid> grid_;
};

}  // namespace scintray::detector
