#include "scintray/analysis/spectrum/spread.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "scintray/analysis/spectrum/detail/grouped_values.hpp"
#include "scintray/core/statistics.hpp"

namespace scintray::analysis {

namespace {

/// Share of a Gaussian below its lower half maximum: Phi(-sqrt(2 ln 2)).
constexpr double kLowerShare = 0.11951572;
constexpr double kReach = 2.5;
constexpr double kCoreBinsPerSigma = 4.0;
constexpr double kLeastInCore = 50.0;
constexpr int kMostCoreRounds = 8;
constexpr std::size_t kLeastInGroup = 4;  // as of jackknife_errors

double quantile_fwhm(std::span<const double> sorted) {
  return sorted_quantile(sorted, 1.0 - kLowerShare) - sorted_quantile(sorted, kLowerShare);
}

/// Error of quantile_fwhm without regard to the distribution: a quarter of the distance between the order
/// statistics two standard deviations (sqrt(q (1 - q) N)) to either side, and the covariance of two order
/// statistics. One standard deviation away are so few values, 11 of 300, that the error is known to 30 %
/// only.
double error_by_order_statistics(std::span<const double> sorted) {
  const auto n = static_cast<double>(sorted.size());
  const double share = kLowerShare;
  const double step = 2.0 * std::sqrt(share * (1.0 - share) / n);
  const auto error = [&](double q) {
    return 0.25 * (sorted_quantile(sorted, q + step) - sorted_quantile(sorted, q - step));
  };
  const double low = error(share), high = error(1.0 - share);
  // Both shares are equally far from the ends, so the correlation is q / (1 - q).
  const double covariance = low * high * share / (1.0 - share);
  return std::sqrt(std::max(0.0, low * low + high * high - 2.0 * covariance));
}

/// Sets the fit, and gaussian_fwhm with the error of the fit.
void fit_core(std::span<const double> sorted, Spread& spread) {
  double centre = sorted_quantile(sorted, 0.5), sigma = quantile_fwhm(sorted) / core::kFwhmPerSigma;
  for (int round = 0; round < kMostCoreRounds; ++round) {
    spread.fitted = make_histogram_of_width(sorted, centre - kReach * sigma, centre + kReach * sigma,
                                            sigma / kCoreBinsPerSigma);
    const PeakFit fit =
        fit_peak(spread.fitted, {centre, sigma, std::max(1.0, spread.fitted.total())}, PeakBackground::none);
    if (!fit.converged) return;
    spread.fit = fit;
    const bool stable = std::abs(fit.model.position - centre) < 0.05 * sigma &&
                        std::abs(fit.model.sigma - sigma) < 0.05 * sigma;
    if (stable) break;
    centre = fit.model.position;
    sigma = std::clamp(fit.model.sigma, 0.5 * sigma, 2.0 * sigma);
  }
  spread.gaussian_fwhm = {core::kFwhmPerSigma * spread.fit.sigma.value,
                          core::kFwhmPerSigma * spread.fit.sigma.error};
}

/// Error of the Gaussian's width by leaving out groups.
void leave_out_groups(const GroupedValues& values, Spread& spread) {
  const auto width_of = [](std::span<const double> kept) -> std::optional<std::vector<double>> {
    Spread without;
    fit_core(kept, without);
    if (!without.fit.converged) return std::nullopt;
    return std::vector{without.gaussian_fwhm.value};
  };
  const std::size_t groups = std::min(Divisions().groups, values.sorted().size() / kLeastInGroup);
  if (const auto errors = jackknife_errors(values, {1, groups}, width_of))
    spread.gaussian_fwhm.error = errors->front();
}

Spread spread_of_groups(const GroupedValues& grouped) {
  const std::vector<double>& sorted = grouped.sorted();
  Spread spread;
  spread.count = sorted.size();
  core::Moments moments;
  // Relative to a value within, so that a small width far from zero keeps its precision.
  const double origin = sorted.empty() ? 0.0 : sorted[sorted.size() / 2];
  for (const double value : sorted) moments.add(value - origin);
  spread.mean = moments.mean();
  spread.mean.value += origin;
  if (sorted.size() < 2 || sorted.front() == sorted.back()) return spread;
  spread.quantile_fwhm = {quantile_fwhm(sorted), error_by_order_statistics(sorted)};
  if (static_cast<double>(sorted.size()) >= kLeastInCore && spread.quantile_fwhm.value > 0.0)
    fit_core(sorted, spread);
  return spread;
}

}  // namespace

Spread spread_of(std::span<const double> values) {
  const GroupedValues grouped(values);
  Spread spread = spread_of_groups(grouped);
  if (spread.fit.converged) leave_out_groups(grouped, spread);
  return spread;
}

Spread quick_spread_of(std::span<const double> values) { return spread_of_groups(GroupedValues(values)); }

}  // namespace scintray::analysis
