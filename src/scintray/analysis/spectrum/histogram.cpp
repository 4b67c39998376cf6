#include "scintray/analysis/spectrum/histogram.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace scintray::analysis {

namespace {

constexpr double kMostBins = 10'000.0;

bool all_whole(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(),
                     [](double value) { return !std::isfinite(value) || value == std::floor(value); });
}

}  // namespace

std::vector<double> Histogram::edges() const {
  std::vector<double> all(counts.size() + 1);
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = edge(i);
  return all;
}

double Histogram::total() const { return std::accumulate(counts.begin(), counts.end(), 0.0); }

Histogram make_histogram(std::span<const double> values, double low, double high, std::size_t bins) {
  if (bins == 0 || !(high > low) || !std::isfinite(high - low))
    throw std::invalid_argument("a histogram needs bins and a range");
  Histogram histogram;
  histogram.low = low;
  histogram.width = (high - low) / static_cast<double>(bins);
  histogram.counts.assign(bins, 0.0);
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    const double bin = std::floor((value - low) / histogram.width);
    if (bin < 0.0)
      histogram.below += 1.0;
    else if (bin >= static_cast<double>(bins))
      histogram.above += 1.0;
    else
      histogram.counts[static_cast<std::size_t>(bin)] += 1.0;
  }
  return histogram;
}

Histogram make_histogram_of_width(std::span<const double> values, double low, double high, double width) {
  width = std::max(width, (high - low) / kMostBins);
  if (all_whole(values)) {
    width = std::max(1.0, std::round(width));
    low = std::floor(low) - 0.5;
  }
  const double bins = std::max(1.0, std::ceil((high - low) / width - 1e-9));
  return make_histogram(values, low, low + bins * width, static_cast<std::size_t>(bins));
}

std::optional<Histogram> automatic_histogram(std::span<const double> values) {
  const std::vector<double> sorted = sorted_finite(values);
  if (sorted.empty() || sorted.front() == sorted.back()) return std::nullopt;
  const double inner_low = sorted_quantile(sorted, 0.001), inner_high = sorted_quantile(sorted, 0.999);
  const double margin = 0.5 * (inner_high - inner_low);
  const bool long_tails = inner_high > inner_low;
  const double low = long_tails ? std::max(sorted.front(), inner_low - margin) : sorted.front();
  const double high = long_tails ? std::min(sorted.back(), inner_high + margin) : sorted.back();
  const double between = sorted_quantile(sorted, 0.75) - sorted_quantile(sorted, 0.25);
  const double root = std::cbrt(static_cast<double>(sorted.size()));
  const double width = between > 0.0 ? 2.0 * between / root : (high - low) / root;
  // The largest value belongs to the last bin, not beyond it.
  return make_histogram_of_width(sorted, low, std::nextafter(high, high + 1.0) + 1e-9 * (high - low), width);
}

double sorted_quantile(std::span<const double> sorted, double share) {
  const double at = std::clamp(share, 0.0, 1.0) * static_cast<double>(sorted.size() - 1);
  const auto i = static_cast<std::size_t>(at);
  if (i + 1 >= sorted.size()) return sorted.back();
  return sorted[i] + (at - static_cast<double>(i)) * (sorted[i + 1] - sorted[i]);
}

std::vector<double> sorted_finite(std::span<const double> values) {
  std::vector<double> sorted;
  sorted.reserve(values.size());
  std::copy_if(values.begin(), values.end(), std::back_inserter(sorted),
               [](double value) { return std::isfinite(value); });
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

}  // namespace scintray::analysis
