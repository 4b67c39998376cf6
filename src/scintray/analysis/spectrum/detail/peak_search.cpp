#include "scintray/analysis/spectrum/detail/peak_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "scintray/analysis/spectrum/detail/smoothing.hpp"
#include "scintray/analysis/spectrum/histogram.hpp"
#include "scintray/core/vec.hpp"

namespace scintray::analysis {

namespace {

constexpr std::size_t kBins = 512;
/// Half width at half maximum of a Gaussian over its standard deviation.
constexpr double kHalfWidth = 1.1774100225154747;
constexpr double kPeakSignificance = 4.0;
constexpr double kLeastHeight = 0.1;

/// Standard error of a height after smoothing: the integral of the squared kernel is 1 / (2 sqrt(pi) width).
double height_error(double height, double width) {
  return std::sqrt(std::max(height, 0.0) / (2.0 * std::sqrt(core::kPi) * width));
}

struct Maximum {
  std::size_t at = 0, valley = 0;
  double height = 0.0;
};

/// Maxima that stand out on both sides, in rising order: a walk that turns only when what it lost or won
/// since the last turn is significant.
std::vector<Maximum> maxima(const std::vector<double>& density, double width) {
  std::vector<Maximum> found;
  std::size_t top = 0, valley = 0;
  bool climbing = true;
  for (std::size_t i = 0; i < density.size(); ++i) {
    if (climbing && density[i] > density[top]) top = i;
    if (!climbing && density[i] < density[valley]) valley = i;
    const double here = density[climbing ? top : i];
    const double limit = kPeakSignificance * height_error(here, width);
    if (climbing && density[top] - density[i] > limit) {
      if (density[top] - density[valley] > limit) found.push_back({top, valley, density[top]});
      climbing = false;
      valley = i;
    } else if (!climbing && density[i] - density[valley] > limit) {
      climbing = true;
      top = i;
    }
  }
  // A spectrum cut off above its peak never comes down again.
  if (climbing && density[top] - density[valley] > kPeakSignificance * height_error(density[top], width))
    found.push_back({top, valley, density[top]});
  return found;
}

/// Standard deviation from so many bins of half width, less what smoothing added.
double sigma_from(std::size_t bins, double width) {
  const double half = static_cast<double>(bins) / kHalfWidth;
  return std::max(0.5, std::sqrt(std::max(half * half - width * width, 0.1 * half * half)));
}

PeakPlace place_of(const Maximum& peak, const std::vector<double>& density, const Histogram& grid,
                   double width) {
  std::size_t right = peak.at, left = peak.at;
  while (right + 1 < density.size() && density[right] > 0.5 * peak.height) ++right;
  while (left > 0 && density[left] > 0.5 * peak.height) --left;
  return {grid.centre(peak.at), sigma_from(right - peak.at, width) * grid.width,
          sigma_from(peak.at - left, width) * grid.width, peak.height / grid.width, grid.centre(peak.valley)};
}

}  // namespace

std::optional<PeakPlace> find_photopeak(std::span<const double> sorted) {
  if (sorted.size() < 2) return std::nullopt;
  const double low = sorted_quantile(sorted, 0.0005), high = sorted_quantile(sorted, 0.9995);
  if (!(high > low)) return std::nullopt;
  const double margin = 0.1 * (high - low);
  const Histogram grid = make_histogram(sorted, low - margin, high + margin, kBins);
  std::optional<PeakPlace> best;
  for (const double width : std::array{24.0, 12.0, 6.0, 3.0, 1.5}) {
    const std::vector<double> density = convolved(grid.counts, gaussian_kernel(width), {1, kBins});
    const std::vector<Maximum> found = maxima(density, width);
    double highest = 0.0;
    for (const Maximum& peak : found) highest = std::max(highest, peak.height);
    const auto last = std::find_if(found.rbegin(), found.rend(), [&](const Maximum& peak) {
      return peak.height >= kLeastHeight * highest;
    });
    if (last == found.rend()) continue;
    best = place_of(*last, density, grid, width);
    if (width * grid.width <= 0.5 * best->sigma) break;
  }
  return best;
}

}  // namespace scintray::analysis
