#pragma once
/// Reweighting of a result to other absorption lengths and reflectances, from its photon histories.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scintray/analysis/reweight.hpp"
#include "scintray/results/history_table.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::simulation {

enum class OpticalProperty { absorption_length, reflectance };

/// Values to which a property is reweighted, one after the other.
struct PropertyScan {
  OpticalProperty property = OpticalProperty::absorption_length;
  /// Name of a medium; or of a reflector, of its stack or of its surface: all those of that name.
  std::string name;
  bool times = false;          ///< values are factors on the traced ones, at every wavelength; else constants
  std::vector<double> values;  ///< mm, infinity for no absorption; or a reflectance, 0 to 1; or factors
};

/// Name of the property: "absorption length of LSO".
std::string describe(const PropertyScan& scan);
/// Text of a value: "200 mm", "none", "0.95", "x 2".
std::string describe_value(const PropertyScan& scan, double value);

/// All combinations of the values of scans, bound to the media and reflectors of the histories.
class ReweightPlan {
 public:
  /// @throws InputError for names that are not in the histories, with the nearest; for values out of their
  ///         range; for properties that reweighting cannot change; for two scans of the same property
  ReweightPlan(const std::filesystem::path& path, const tally::RunResult& run,
               const results::HistoryColumns& columns, const std::vector<PropertyScan>& scans);

  /// Combinations of the values of all scans, the last scan's fastest.
  const std::vector<std::vector<double>>& choices() const { return choices_; }
  /// Optics of a combination at a point. @throws InputError for a factor that raises a reflectance above 1
  analysis::OpticalChange change(const results::TracedOptics& traced,
                                 const std::vector<double>& choice) const;

 private:
  std::filesystem::path path_;
  std::vector<PropertyScan> scans_;
  std::vector<std::vector<std::size_t>> targets_;  ///< columns that each scan changes
  std::vector<std::vector<double>> choices_;
  std::vector<std::string> reflector_names_;
};

/// One point of the run with one combination of values.
struct ReweightedPoint {
  std::size_t point = 0;           ///< index into RunResult::points
  std::vector<double> values;      ///< one for each scan
  core::Estimate traced_fraction;  ///< detected over emitted, as traced
  analysis::Reweighted light;
  /// Of an event source: mean number of detected photons of an event with energy in a scintillator.
  std::optional<core::Estimate> traced_per_event, per_event;
};

/// Reweighted points of the run for all combinations of the scans' values, the last scan's values fastest,
/// points slowest; the histories are read once. For an event source all errors are those of sums over events:
/// photons of one event share its position and energy.
/// @throws InputError without histories; for names that are not in the histories, with the nearest; for
///         values out of their range; for properties that reweighting cannot change
[[nodiscard]] std::vector<ReweightedPoint> reweight_results(const std::filesystem::path& path,
                                                            const tally::RunResult& run,
                                                            const std::vector<PropertyScan>& scans);

}  // namespace scintray::simulation
