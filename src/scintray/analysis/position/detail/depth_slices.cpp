#include "scintray/analysis/position/detail/depth_slices.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace scintray::analysis {

std::vector<DepthSlice> slice_by_depth(std::span<const double> depths_mm, std::span<const double> values,
                                       std::size_t slices, std::size_t least) {
  if (depths_mm.size() != values.size()) throw std::invalid_argument("depths and values differ in number");
  const auto usable = [&](std::size_t i) { return std::isfinite(depths_mm[i]) && std::isfinite(values[i]); };
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!usable(i)) continue;
    low = std::min(low, depths_mm[i]);
    high = std::max(high, depths_mm[i]);
  }
  std::vector<DepthSlice> all(std::max<std::size_t>(1, slices));
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!usable(i)) continue;
    const double share = high > low ? (depths_mm[i] - low) / (high - low) : 0.0;
    const auto at =
        std::min(all.size() - 1, static_cast<std::size_t>(share * static_cast<double>(all.size())));
    all[at].depths_mm.push_back(depths_mm[i]);
    all[at].values.push_back(values[i]);
  }
  std::erase_if(
      all, [&](const DepthSlice& slice) { return slice.values.size() < std::max<std::size_t>(1, least); });
  for (DepthSlice& slice : all) slice.depth_mm = mean_of(slice.depths_mm).value;
  return all;
}

core::Estimate mean_of(const std::vector<double>& values) {
  if (values.empty()) return {};
  core::Moments moments;
  for (const double value : values) moments.add(value - values.front());
  core::Estimate mean = moments.mean();
  mean.value += values.front();
  return mean;
}

}  // namespace scintray::analysis
