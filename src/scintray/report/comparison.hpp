#pragma once
/// Comparison of results, number by number.

#include <optional>
#include <string>
#include <vector>

#include "scintray/report/run_analysis.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::report {

/// A result with the name under which it is shown.
struct NamedResult {
  std::string name;
  tally::RunResult run;
  RunAnalysis analyses;
};

/// A quantity of a point in several results.
struct ComparedNumber {
  std::string point;                                  ///< label of the point: its swept values
  std::string quantity;                               ///< "detected", "energy resolution (FWHM)", ...
  std::vector<std::optional<core::Estimate>> values;  ///< in the order of the results; nothing: it has none
  /// Difference from the first result over the standard error of the difference, for each result; nothing for
  /// the first, for one without the quantity, and where both errors are zero.
  std::vector<std::optional<double>> sigmas;
};

/// Quantities of all points that the first result has, in its order: shares of the photons by fate, light and
/// photons detected per event, photopeak, resolution, depth of interaction and coincidence time resolution.
/// Points are matched by their swept values; a single point by itself. A quantity that no two results have is
/// left out. @throws std::invalid_argument without results
std::vector<ComparedNumber> compare_results(const std::vector<NamedResult>& results);

/// The comparison for a terminal: a table, the largest difference, and how often a difference is so large by
/// chance.
std::string comparison_text(const std::vector<NamedResult>& results);

/// The comparison as a self-contained page.
std::string comparison_page(const std::vector<NamedResult>& results);

}  // namespace scintray::report
