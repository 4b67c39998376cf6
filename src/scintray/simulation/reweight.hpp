#pragma once
/// A result under other absorption lengths and reflectances, from its photon histories.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scintray/simulation/reweight_plan.hpp"

namespace scintray::simulation {

/// One point of the run under one choice of values.
struct ReweightedPoint {
  std::size_t point = 0;           ///< index into RunResult::points
  std::vector<double> values;      ///< one for each scan
  core::Estimate traced_fraction;  ///< detected over emitted, as traced
  analysis::Reweighted light;
  /// Of a source of energy: mean of the detected photons of an event that left energy in a scintillator.
  std::optional<core::Estimate> traced_per_event, per_event;
};

/// Reads the histories once and reweights every point of the run for all combinations of the scans' values,
/// the last scan's values fastest, points slowest. For a source of energy all errors are those of sums over
/// events: photons of one event share its place and energy.
/// @throws InputError without histories; for names that histories do not know, named with the nearest; for
/// values
///         out of their range; for what reweighting cannot change
std::vector<ReweightedPoint> reweight_results(const std::filesystem::path& path, const tally::RunResult& run,
                                              const std::vector<PropertyScan>& scans);

}  // namespace scintray::simulation
