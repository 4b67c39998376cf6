#include "spread.hpp"

#include <algorithm>

#include "scintray/analysis/spectrum/histogram.hpp"
#include "scintray/core/error.hpp"

namespace scintray::bench {

double Spread::relative() const { return median == 0.0 ? 0.0 : 0.5 * (high - low) / median; }

Spread spread_of(std::vector<double> values) {
  if (values.empty()) throw core::InternalError("a spread of no values");
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  const auto quantile = [&](double share) { return analysis::sorted_quantile(sorted, share); };
  return {quantile(0.5), quantile(0.25), quantile(0.75), std::move(values)};
}

Spread paired_ratio(std::span<const double> above, std::span<const double> below) {
  if (above.size() != below.size()) throw core::InternalError("ratios of unequal numbers of measurements");
  std::vector<double> ratios;
  for (std::size_t i = 0; i < above.size(); ++i) ratios.push_back(above[i] / below[i]);
  return spread_of(std::move(ratios));
}

}  // namespace scintray::bench
