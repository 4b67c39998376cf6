#pragma once
/// Medians of repeated measurements.

#include <span>
#include <vector>

namespace scintray::bench {

/// Repeated measurements of one figure.
struct Spread {
  double median = 0.0;
  double low = 0.0, high = 0.0;  ///< quartiles
  std::vector<double> values;    ///< in the order of measurement

  /// Half the distance between the quartiles as a share of the median; 0 for a median of 0.
  double relative() const;
};

/// Median and quartiles, linear between values. @throws InternalError without a value
Spread spread_of(std::vector<double> values);

/// Spread of the ratios of measurements made side by side: value i of one over value i of the other. A change
/// of the machine's speed that lasts longer than one measurement cancels.
/// @throws InternalError when their numbers differ
Spread paired_ratio(std::span<const double> above, std::span<const double> below);

}  // namespace scintray::bench
