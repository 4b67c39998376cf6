#include "scintray/analysis/spectrum/photopeak.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scintray/analysis/spectrum/detail/peak_search.hpp"

namespace scintray::analysis {

namespace {

constexpr double kLeastInPeak = 100.0;
constexpr double kBelow = 3.0, kAbove = 4.0, kLeastBelow = 1.5;
constexpr double kPeakBinsPerSigma = 4.0;
constexpr double kWorthATerm = 9.0;
constexpr double kPoor = 1e-4;
constexpr double kSmallMisfit = 0.01;
constexpr int kMostPeakRounds = 8;

PeakFit fit_with_background(const Histogram& histogram, PeakModel start, const PhotopeakOptions& options) {
  if (options.background) return fit_peak(histogram, start, *options.background);
  PeakFit best = fit_peak(histogram, start, PeakBackground::none);
  for (const PeakBackground more : {PeakBackground::shoulder, PeakBackground::shoulder_and_constant}) {
    const PeakFit richer = fit_peak(histogram, start, more);
    if (richer.converged && (!best.converged || best.deviance - richer.deviance > kWorthATerm)) best = richer;
  }
  return best;
}

/// First guess of the heights, from the counts of the outermost bins.
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

Span span_of(double position, double sigma, double valley, const PhotopeakOptions& options) {
  Span span{std::max(position - kBelow * sigma, std::min(valley, position - kLeastBelow * sigma)),
            position + kAbove * sigma};
  if (options.window) {
    span.low = std::max(span.low, options.window->front());
    span.high = std::min(span.high, options.window->back());
  }
  return span;
}

Photopeak verdict(Photopeak peak, PeakVerdict found, std::string reason) {
  peak.verdict = found;
  peak.reason = std::move(reason);
  return peak;
}

/// Values within 0.1 sigma of an end of the data, where these end on the slope of the peak: as many as a
/// quarter of its height makes are no tail.
bool cut_off(std::span<const double> sorted, const PeakPlace& place, bool above) {
  const double sigma = above ? place.sigma_below : place.sigma;
  const double room = above ? sorted.back() - place.position : place.position - sorted.front();
  if (room > kLeastBelow * sigma) return false;
  const double reach = 0.1 * sigma;
  const auto near_end =
      above ? sorted.end() - std::lower_bound(sorted.begin(), sorted.end(), sorted.back() - reach)
            : std::upper_bound(sorted.begin(), sorted.end(), sorted.front() + reach) - sorted.begin();
  return static_cast<double>(near_end) > 0.25 * place.height * reach;
}

/// Repeats the fit until the bins it used are those that its result asks for.
void fit_until_settled(std::span<const double> sorted, const PeakPlace& place,
                       const PhotopeakOptions& options, Photopeak& peak) {
  double position = place.position, sigma = place.sigma;
  for (int round = 0; round < kMostPeakRounds; ++round) {
    const Span span = span_of(position, sigma, place.valley, options);
    if (!(span.high > span.low)) return;
    peak.fitted = make_histogram_of_width(sorted, span.low, span.high, sigma / kPeakBinsPerSigma);
    if (peak.fitted.total() < kLeastInPeak) return;
    const PeakFit fit = fit_with_background(peak.fitted, start_model(peak.fitted, position, sigma), options);
    if (!fit.converged) return;
    const bool settled = std::abs(fit.model.position - position) < 0.05 * sigma &&
                         std::abs(fit.model.sigma - sigma) < 0.05 * sigma;
    peak.fit = fit;
    if (settled) return;
    position = fit.model.position;
    sigma = std::clamp(fit.model.sigma, 0.5 * sigma, 2.0 * sigma);
  }
}

}  // namespace

const char* verdict_name(PeakVerdict verdict) {
  switch (verdict) {
    case PeakVerdict::trusted:
      return "trusted";
    case PeakVerdict::too_few:
      return "too few events";
    case PeakVerdict::no_peak:
      return "no peak";
    case PeakVerdict::edge_of_range:
      return "peak at the edge";
    case PeakVerdict::not_converged:
      return "the fit did not converge";
    case PeakVerdict::poor_fit:
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
  return verdict == PeakVerdict::trusted || (verdict == PeakVerdict::poor_fit && misfit() < kSmallMisfit);
}

Photopeak fit_photopeak(std::span<const double> values, const PhotopeakOptions& options) {
  Photopeak peak;
  std::vector<double> sorted = sorted_finite(values);
  if (options.window) {
    const auto inside = std::partition_point(sorted.begin(), sorted.end(),
                                             [&](double x) { return x <= options.window->back(); });
    sorted.erase(inside, sorted.end());
    sorted.erase(sorted.begin(), std::lower_bound(sorted.begin(), sorted.end(), options.window->front()));
  }
  if (static_cast<double>(sorted.size()) < kLeastInPeak)
    return verdict(peak, PeakVerdict::too_few,
                   fmt::format("{} pulses; a fit needs {:.0f} in the peak", sorted.size(), kLeastInPeak));
  const std::optional<PeakPlace> place = find_photopeak(sorted);
  if (!place)
    return verdict(peak, PeakVerdict::no_peak,
                   sorted.front() == sorted.back() ? "all pulses are equal"
                                                   : "no maximum stands 4 standard errors above its sides");
  for (const bool above : {true, false})
    if (cut_off(sorted, *place, above))
      return verdict(peak, PeakVerdict::edge_of_range,
                     fmt::format("the data end at {:.4g}, on the slope of the peak at {:.4g}",
                                 above ? sorted.back() : sorted.front(), place->position));
  fit_until_settled(sorted, *place, options, peak);
  if (!peak.has_numbers()) {
    if (peak.fitted.total() < kLeastInPeak)
      return verdict(peak, PeakVerdict::too_few,
                     fmt::format("{:.0f} pulses near the peak at {:.4g}; a fit needs {:.0f}",
                                 peak.fitted.total(), place->position, kLeastInPeak));
    return verdict(peak, PeakVerdict::not_converged,
                   fmt::format("the fit of the peak near {:.4g} did not come to rest", place->position));
  }
  const PeakModel& model = peak.fit.model;
  const double room_above = (sorted.back() - model.position) / model.sigma;
  const double room_below = (model.position - sorted.front()) / model.sigma;
  if (room_above < kLeastBelow || room_below < kLeastBelow)
    return verdict(
        peak, PeakVerdict::edge_of_range,
        fmt::format("the peak at {:.4g} has {:.1f} sigma of data below it and {:.1f} above; {} are needed",
                    model.position, room_below, room_above, kLeastBelow));
  if (model.events < kLeastInPeak)
    return verdict(peak, PeakVerdict::too_few,
                   fmt::format("{:.0f} pulses in the peak; {:.0f} are needed", model.events, kLeastInPeak));
  if (peak.fit.goodness.degrees > 0.0 && peak.fit.goodness.p_value < kPoor)
    return verdict(
        peak, PeakVerdict::poor_fit,
        fmt::format("chi-square {:.1f} for {:.0f} degrees of freedom (p {:.1g}): the peak is no Gaussian on "
                    "a shoulder",
                    peak.fit.goodness.chi2, peak.fit.goodness.degrees, peak.fit.goodness.p_value));
  return verdict(peak, PeakVerdict::trusted, "");
}

}  // namespace scintray::analysis
