#pragma once
/// A result under other absorption lengths and reflectances, from its photon histories.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scintray/analysis/reweight.hpp"
#include "scintray/results/history_table.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::simulation {

enum class OpticalProperty { absorption_length, reflectance };

/// Values that a property is wanted at, one after the other.
struct PropertyScan {
  OpticalProperty property = OpticalProperty::absorption_length;
  /// Of a medium; or of a reflector, the stack or the surface that it is behind: all those of that name.
  std::string name;
  bool times = false;          ///< values are factors on what was traced, at every wavelength; else constants
  std::vector<double> values;  ///< mm, infinity for no absorption; or a reflectance, 0 to 1; or factors
};

/// "absorption length of LSO"
std::string describe(const PropertyScan& scan);
/// "200 mm", "none", "0.95", "x 2"
std::string describe_value(const PropertyScan& scan, double value);

/// All combinations of the values of scans, bound to the media and reflectors of the histories.
class ReweightPlan {
 public:
  /// @throws InputError for names that the histories do not know, named with the nearest; for values out of
  /// their
  ///         range; for what reweighting cannot change; for two scans of the same thing
  ReweightPlan(const std::filesystem::path& path, const tally::RunResult& run,
               const results::HistoryColumns& columns, const std::vector<PropertyScan>& scans);

  /// Values of all scans, the last scan's fastest.
  const std::vector<std::vector<double>>& choices() const { return choices_; }
  /// What a choice changes at a point. @throws InputError for a factor that lifts a reflectance above 1
  analysis::OpticalChange change(const results::TracedOptics& traced,
                                 const std::vector<double>& choice) const;

 private:
  std::filesystem::path path_;
  std::vector<PropertyScan> scans_;
  std::vector<std::vector<std::size_t>> targets_;  ///< columns that each scan changes
  std::vector<std::vector<double>> choices_;
  std::vector<std::string> reflector_names_;
};

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
[[nodiscard]] std::vector<ReweightedPoint> reweight_results(const std::filesystem::path& path,
                                                            const tally::RunResult& run,
                                                            const std::vector<PropertyScan>& scans);

}  // namespace scintray::simulation
