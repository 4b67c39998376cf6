#include "scintray/analysis/spectrum/photopeak.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "scintray/analysis/spectrum/detail/grouped_values.hpp"
#include "scintray/analysis/spectrum/detail/smoothing.hpp"
#include "scintray/core/statistics.hpp"
#include "scintray/core/vec.hpp"

namespace scintray::analysis {

namespace {

constexpr double kLeastInPeak = 100.0;
constexpr double kBelow = 3.0, kAbove = 4.0, kLeastBelow = 1.5, kFlanks = 1.6;
constexpr double kPeakBinsPerSigma = 4.0;
constexpr double kPoor = 1e-4;
constexpr double kSmallMisfit = 0.01;
/// Relative error of sigma from which on its errors are no longer those of a normal distribution: in some
/// runs a shoulder has then taken over a side of the peak, and sigma is up to four of its errors too small
/// (docs/decisions.md).
constexpr double kUncertainWidth = 0.125;
constexpr int kMostPeakRounds = 8;
/// Height of a continuum 3 sigma below the peak over the valley, in heights of the peak, from which on it is
/// not fitted.
constexpr double kRise = 0.07;
/// Change of position and sigma, in sigma, below which a fit is not repeated.
constexpr double kStable = 0.02;
/// Share of the sigma of its range below which a fit has found a fluctuation in place of the peak.
constexpr double kLeastShrinking = 0.25;
/// Quarters: what steps remain (bins, the range) are enlarged less than by smaller groups; 36 degrees of
/// freedom.
constexpr Divisions kDivisions{.number = 12, .groups = 4};

/// Approximate photopeak of a spectrum: the start of a fit.
struct PeakPlace {
  double position = 0.0;
  double sigma = 0.0;        ///< from the half width at half maximum above the peak
  double sigma_below = 0.0;  ///< from that below it: a shoulder makes it larger
  double height = 0.0;       ///< density of values at the peak, smoothed
};

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
  std::size_t at = 0;
  double height = 0.0;
};

/// Significant maxima, in rising order: a walk that turns only when its decrease or increase
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
      if (density[top] - density[valley] > limit) found.push_back({top, density[top]});
      climbing = false;
      valley = i;
    } else if (!climbing && density[i] - density[valley] > limit) {
      climbing = true;
      top = i;
    }
  }
  // A spectrum truncated above its peak does not decrease again.
  if (climbing && density[top] - density[valley] > kPeakSignificance * height_error(density[top], width))
    found.push_back({top, density[top]});
  return found;
}

/// Standard deviation from a half width in bins, corrected for the smoothing.
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
          sigma_from(peak.at - left, width) * grid.width, peak.height / grid.width};
}

/// The highest in x of the significant maxima with a tenth of the height of the highest; see
/// fit_photopeak. @param sorted  rising, finite
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

/// Initial heights, from the counts of the outermost bins.
PeakModel start_model(const Histogram& histogram, double position, double sigma) {
  PeakModel start;
  start.position = position;
  start.sigma = sigma;
  const double first = histogram.counts.front() / histogram.width,
               last = histogram.counts.back() / histogram.width;
  const double total = histogram.total();
  start.constant = 0.5 * last;
  start.shoulder = 0.5 * std::max(0.0, first - last);
  start.events = std::max(0.2 * total, total - start.shoulder * (position - histogram.low) -
                                           start.constant * (histogram.high() - histogram.low));
  return start;
}

struct Span {
  double low = 0.0, high = 0.0;
};

/// How far below a peak its model holds, in sigma: kBelow, but less as a continuum rises within that. Found
/// from the density, smoothed by a third of sigma, without steps: the valley's place, whose bottom is flat,
/// would be known to a sigma only. So the flank is where the density has fallen to a quarter of its height
/// above the valley.
double reach_below(std::span<const double> sorted, double position, double sigma) {
  constexpr std::size_t kCells = 16;  // a sigma
  constexpr std::size_t kPeak = 5 * kCells, kEnd = 6 * kCells, kFirst = kPeak - 3 * kCells;
  const Histogram near = make_histogram(sorted, position - 5.0 * sigma, position + sigma, kEnd);
  const std::vector<double> density = convolved(near.counts, gaussian_kernel(kCells / 3.0), {1, kEnd});
  const double valley = *std::min_element(density.begin() + kFirst, density.begin() + kPeak);
  const double height = density[kPeak] - valley;
  if (!(height > 0.0)) return kBelow;
  std::size_t at = kPeak;
  while (at > kFirst && density[at - 1] > valley + 0.25 * height) --at;
  const double step = density[at] - density[at - 1];
  const double part = step > 0.0 ? (density[at] - valley - 0.25 * height) / step : 0.0;
  const double flank = (static_cast<double>(kPeak - at) + std::clamp(part, 0.0, 1.0)) / kCells;
  const double rise = std::clamp((density[kFirst] - valley) / (kRise * height), 0.0, 1.0);
  return (1.0 - rise) * kBelow + rise * std::clamp(kFlanks * flank, kLeastBelow, kBelow);
}

Span span_of(std::span<const double> sorted, double position, double sigma, const PhotopeakOptions& options) {
  Span span{position - reach_below(sorted, position, sigma) * sigma, position + kAbove * sigma};
  if (options.window) {
    span.low = std::max(span.low, options.window->front());
    span.high = std::min(span.high, options.window->back());
  }
  return span;
}

Photopeak with_status(Photopeak peak, PeakStatus found, std::string reason) {
  peak.status = found;
  peak.reason = std::move(reason);
  return peak;
}

/// True when the data end on the slope of the peak: when the values within 0.1 sigma of an end are more than
/// a quarter of those in such an interval at the peak.
bool cut_off(std::span<const double> sorted, const PeakPlace& place, bool above) {
  const double sigma = above ? place.sigma_below : place.sigma;
  const double margin = above ? sorted.back() - place.position : place.position - sorted.front();
  if (margin > kLeastBelow * sigma) return false;
  const double reach = 0.1 * sigma;
  const auto near_end =
      above ? sorted.end() - std::lower_bound(sorted.begin(), sorted.end(), sorted.back() - reach)
            : std::upper_bound(sorted.begin(), sorted.end(), sorted.front() + reach) - sorted.begin();
  return static_cast<double>(near_end) > 0.25 * place.height * reach;
}

/// Repeats the fit until its bins are those that its result requires.
void fit_until_stable(std::span<const double> sorted, const PeakPlace& place, const PhotopeakOptions& options,
                      double least, Photopeak& peak) {
  double position = place.position, sigma = place.sigma;
  for (int round = 0; round < kMostPeakRounds; ++round) {
    const Span span = span_of(sorted, position, sigma, options);
    if (!(span.high > span.low)) return;
    peak.fitted = make_histogram_of_width(sorted, span.low, span.high, sigma / kPeakBinsPerSigma);
    if (peak.fitted.total() < least) return;
    const PeakModel start = start_model(peak.fitted, position, sigma);
    const PeakFit fit =
        options.background ? fit_peak(peak.fitted, start, *options.background) : fit_peak(peak.fitted, start);
    if (!fit.converged) return;
    if (fit.model.sigma < kLeastShrinking * sigma) {
      // A fluctuation in a range that is too narrow for the peak.
      sigma *= 2.0;
      continue;
    }
    const bool stable = std::abs(fit.model.position - position) < kStable * sigma &&
                        std::abs(fit.model.sigma - sigma) < kStable * sigma;
    peak.fit = fit;
    if (stable) return;
    position = fit.model.position;
    sigma = std::clamp(fit.model.sigma, 0.5 * sigma, 2.0 * sigma);
  }
}

/// Errors by leaving out groups: the model has not the exact shape of a spectrum of gammas, and the range and
/// the background that are fitted depend on the values, which the errors of a single fit do not include.
/// Where one of the other fits does not converge, the errors of the fit remain.
void leave_out_groups(const GroupedValues& values, const PeakPlace& place, const PhotopeakOptions& options,
                      PeakFit& fit) {
  PeakPlace found = place;
  found.position = fit.model.position;
  found.sigma = fit.model.sigma;
  const auto fit_of = [&](std::span<const double> kept) -> std::optional<std::vector<double>> {
    Photopeak without;
    fit_until_stable(kept, found, options, 0.0, without);
    if (!without.fit.converged) return std::nullopt;
    return std::vector{without.fit.position.value, without.fit.sigma.value, without.fit.relative_fwhm.value,
                       without.fit.events.value / static_cast<double>(kept.size())};
  };
  const auto errors = jackknife_errors(values, kDivisions, fit_of);
  if (!errors) return;
  fit.position.error = (*errors)[0];
  fit.sigma.error = (*errors)[1];
  fit.relative_fwhm.error = (*errors)[2];
  // Of a share of the values, whose number fluctuates as a Poisson variable.
  const auto number = static_cast<double>(values.sorted().size());
  fit.events.error = std::hypot(number * (*errors)[3], fit.events.value / std::sqrt(number));
}

}  // namespace

const char* status_name(PeakStatus status) {
  switch (status) {
    case PeakStatus::trusted:
      return "trusted";
    case PeakStatus::too_few:
      return "too few events";
    case PeakStatus::no_peak:
      return "no peak";
    case PeakStatus::edge_of_range:
      return "peak at the edge";
    case PeakStatus::not_converged:
      return "the fit did not converge";
    case PeakStatus::uncertain_width:
      return "uncertain width";
    case PeakStatus::poor_fit:
      return "poor fit";
  }
  return "";
}

double Photopeak::misfit() const {
  const double pulses = fitted.total();
  if (!fit.converged || pulses <= 0.0) return 0.0;
  return std::max(0.0, fit.goodness.chi2 - fit.goodness.degrees) / pulses;
}

bool Photopeak::locates_peak() const {
  return status == PeakStatus::trusted || status == PeakStatus::uncertain_width ||
         (status == PeakStatus::poor_fit && misfit() < kSmallMisfit);
}

Photopeak fit_photopeak(std::span<const double> values, const PhotopeakOptions& options) {
  Photopeak peak;
  GroupedValues grouped(values);
  if (options.window) grouped.keep_between(options.window->front(), options.window->back());
  const std::vector<double>& sorted = grouped.sorted();
  if (static_cast<double>(sorted.size()) < kLeastInPeak)
    return with_status(
        peak, PeakStatus::too_few,
        fmt::format("{} pulses; a fit requires {:.0f} in the peak", sorted.size(), kLeastInPeak));
  const std::optional<PeakPlace> place = find_photopeak(sorted);
  if (!place)
    return with_status(peak, PeakStatus::no_peak,
                       sorted.front() == sorted.back() ? "all pulses are equal"
                                                       : "no maximum is 4 standard errors above its sides");
  for (const bool above : {true, false})
    if (cut_off(sorted, *place, above))
      return with_status(peak, PeakStatus::edge_of_range,
                         fmt::format("the data end at {:.4g}, on the slope of the peak at {:.4g}",
                                     above ? sorted.back() : sorted.front(), place->position));
  fit_until_stable(sorted, *place, options, kLeastInPeak, peak);
  if (!peak.has_numbers()) {
    if (peak.fitted.total() < kLeastInPeak)
      return with_status(peak, PeakStatus::too_few,
                         fmt::format("{:.0f} pulses near the peak at {:.4g}; a fit requires {:.0f}",
                                     peak.fitted.total(), place->position, kLeastInPeak));
    return with_status(peak, PeakStatus::not_converged,
                       fmt::format("the fit of the peak near {:.4g} did not converge", place->position));
  }
  leave_out_groups(grouped, *place, options, peak.fit);
  const PeakModel& model = peak.fit.model;
  const double margin_above = (sorted.back() - model.position) / model.sigma;
  const double margin_below = (model.position - sorted.front()) / model.sigma;
  if (margin_above < kLeastBelow || margin_below < kLeastBelow)
    return with_status(
        peak, PeakStatus::edge_of_range,
        fmt::format("the peak at {:.4g} has {:.1f} sigma of data below it and {:.1f} above; {} are needed",
                    model.position, margin_below, margin_above, kLeastBelow));
  if (model.events < kLeastInPeak)
    return with_status(
        peak, PeakStatus::too_few,
        fmt::format("{:.0f} pulses in the peak; {:.0f} are needed", model.events, kLeastInPeak));
  if (peak.fit.goodness.degrees > 0.0 && peak.fit.goodness.p_value < kPoor)
    return with_status(
        peak, PeakStatus::poor_fit,
        fmt::format(
            "chi-square {:.1f} for {:.0f} degrees of freedom (p {:.1g}): the peak is not a Gaussian on "
            "a shoulder",
            peak.fit.goodness.chi2, peak.fit.goodness.degrees, peak.fit.goodness.p_value));
  if (peak.fit.sigma.error > kUncertainWidth * model.sigma)
    return with_status(
        peak, PeakStatus::uncertain_width,
        fmt::format(
            "the width is known to {:.0f} %, and has to be to {:.1f} %: peak and background cannot be "
            "distinguished with {:.0f} pulses",
            100.0 * peak.fit.sigma.error / model.sigma, 100.0 * kUncertainWidth, peak.fitted.total()));
  return with_status(peak, PeakStatus::trusted, "");
}

}  // namespace scintray::analysis
