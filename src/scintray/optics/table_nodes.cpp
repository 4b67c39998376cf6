#include "scintray/optics/table_nodes.hpp"

#include <span>

#include "scintray/core/vec.hpp"

namespace scintray::optics {

namespace {

constexpr float kQuarterTurn = static_cast<float>(0.5 * core::kPi), kHalfTurn = static_cast<float>(core::kPi);

/// Quantile of a sorted sample within [low, high]; order statistic k stands for the level (k + 1/2)/n. The
/// half step beyond the first and the last has the slope of the step before it: ending at the extreme rays of
/// a small sample would leave the tails of the distribution empty.
float quantile(std::span<const float> sorted, double level, float low, float high) {
  const double n = static_cast<double>(sorted.size());
  if (sorted.size() == 1) return sorted.front();
  const double rank = std::clamp(level * n - 0.5, -0.5, n - 0.5);
  const std::size_t k =
      std::min(static_cast<std::size_t>(std::max(0.0, rank)), sorted.size() - 2);  // steps from k to k + 1
  const float share = static_cast<float>(rank - static_cast<double>(k));           // -1/2 to 3/2
  return std::clamp(sorted[k] + share * (sorted[k + 1] - sorted[k]), low, high);
}

}  // namespace

DirectionQuantiles quantiles_of(std::vector<ExitAngles>& sample, AzimuthKind kind) {
  DirectionQuantiles result;
  result.rays = sample.size();
  if (sample.empty()) return result;
  // The azimuth breaks ties, so that the result depends on the sample as a set only.
  std::sort(sample.begin(), sample.end(), [](const ExitAngles& a, const ExitAngles& b) {
    return a.polar != b.polar ? a.polar < b.polar : a.azimuth < b.azimuth;
  });
  std::vector<float> values(sample.size());
  std::transform(sample.begin(), sample.end(), values.begin(), [](const ExitAngles& e) { return e.polar; });
  for (int k = 0; k <= kPolarBins; ++k)
    result.polar.push_back(quantile(values, polar_level(k), 0.0f, kQuarterTurn));

  const double n = static_cast<double>(sample.size());
  for (int k = 0; k < kPolarBins; ++k) {
    // Rays of the bin; a bin narrower than one ray uses the nearest.
    const auto first = std::min(static_cast<std::size_t>(polar_level(k) * n), sample.size() - 1);
    const auto last = std::max(static_cast<std::size_t>(polar_level(k + 1) * n), first + 1);
    values.clear();
    for (std::size_t r = first; r < last; ++r) values.push_back(sample[r].azimuth);
    std::sort(values.begin(), values.end());
    for (int c = 0; c <= kAzimuthBins; ++c)
      result.azimuth.push_back(kind == AzimuthKind::folded
                                   ? quantile(values, azimuth_level(c), 0.0f, kHalfTurn)
                                   : quantile(values, signed_azimuth_level(c), -kHalfTurn, kHalfTurn));
  }
  return result;
}

}  // namespace scintray::optics
