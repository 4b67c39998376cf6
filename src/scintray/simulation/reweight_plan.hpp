#pragma once
/// What a result is wanted under, bound to the media and reflectors of its histories.

#include <filesystem>
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

/// All combinations of the values of scans.
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

}  // namespace scintray::simulation
