#include "scintray/analysis/position/depth_of_interaction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "scintray/analysis/position/detail/depth_slices.hpp"
#include "scintray/core/error.hpp"

namespace scintray::analysis {

namespace {

constexpr std::size_t kLeastWithBothEnds = 100, kLeastOfDoiSlice = 10;
/// A slope below this many standard errors is no calibration.
constexpr double kLeastSlope = 5.0;
/// Groups of events of the jackknife.
constexpr std::size_t kGroups = 32;

core::InputError no_doi(const std::string& what, const std::string& hint) {
  return core::InputError(core::Problem{{}, what, hint});
}

struct Calibrated {
  std::vector<DepthSlice> slices;
  std::vector<core::Estimate> means;
  StraightLine line;
};

Calibrated line_of_means(std::span<const double> depths_mm, std::span<const double> ratios,
                         std::size_t slices) {
  Calibrated result;
  result.slices = slice_by_depth(depths_mm, ratios, slices, kLeastOfDoiSlice);
  std::vector<double> depths;
  for (const DepthSlice& slice : result.slices) {
    result.means.push_back(mean_of(slice.values));
    // Ratios without any spread are exact; the line still needs a weight.
    result.means.back().error = std::max(result.means.back().error, 1e-12);
    depths.push_back(slice.depth_mm);
  }
  if (depths.size() < 2)
    throw no_doi("the events lie at one depth", "depth of interaction needs events at several depths");
  result.line = fit_line(depths, result.means);
  if (std::abs(result.line.slope.value) < kLeastSlope * result.line.slope.error)
    throw no_doi("the ratio of the two ends does not change with depth",
                 "use more events, or a rougher crystal");
  return result;
}

/// Isotonic least squares of values with weights (pool adjacent violators).
std::vector<double> isotonic(const std::vector<double>& values, const std::vector<double>& weights) {
  struct Pool {
    double mean, weight;
    std::size_t members;
  };
  std::vector<Pool> pools;
  for (std::size_t i = 0; i < values.size(); ++i) {
    pools.push_back({values[i], weights[i], 1});
    while (pools.size() > 1 && pools[pools.size() - 2].mean > pools.back().mean) {
      const Pool last = pools.back();
      pools.pop_back();
      Pool& into = pools.back();
      into.mean = (into.mean * into.weight + last.mean * last.weight) / (into.weight + last.weight);
      into.weight += last.weight;
      into.members += last.members;
    }
  }
  std::vector<double> fitted;
  for (const Pool& pool : pools) fitted.insert(fitted.end(), pool.members, pool.mean);
  return fitted;
}

DoiCalibration monotone_calibration(const Calibrated& calibrated) {
  const double sign = calibrated.line.slope.value > 0.0 ? 1.0 : -1.0;
  std::vector<double> values, weights;
  for (const core::Estimate& mean : calibrated.means) {
    values.push_back(sign * mean.value);
    weights.push_back(1.0 / (mean.error * mean.error));
  }
  const std::vector<double> fitted = isotonic(values, weights);
  DoiCalibration calibration;
  for (std::size_t i = 0; i < fitted.size();) {
    // Pooled slices share one ratio, which is assigned to their mean depth.
    std::size_t end = i;
    double depth = 0.0;
    while (end < fitted.size() && fitted[end] == fitted[i]) depth += calibrated.slices[end++].depth_mm;
    calibration.ratio.push_back(sign * fitted[i]);
    calibration.depth_mm.push_back(depth / static_cast<double>(end - i));
    i = end;
  }
  if (calibration.ratio.size() < 2)
    throw no_doi("the ratio of the two ends does not change steadily with depth", "use more events");
  if (sign < 0.0) {
    std::reverse(calibration.ratio.begin(), calibration.ratio.end());
    std::reverse(calibration.depth_mm.begin(), calibration.depth_mm.end());
  }
  return calibration;
}

DoiCalibration linear_calibration(const Calibrated& calibrated) {
  DoiCalibration calibration;
  for (const double depth : {calibrated.slices.front().depth_mm, calibrated.slices.back().depth_mm}) {
    calibration.ratio.push_back(calibrated.line.at(depth).value);
    calibration.depth_mm.push_back(depth);
  }
  if (calibration.ratio[0] > calibration.ratio[1]) {
    std::swap(calibration.ratio[0], calibration.ratio[1]);
    std::swap(calibration.depth_mm[0], calibration.depth_mm[1]);
  }
  return calibration;
}

DoiCalibration calibration_of(const Calibrated& calibrated, DoiCalibrationKind kind) {
  return kind == DoiCalibrationKind::linear ? linear_calibration(calibrated)
                                            : monotone_calibration(calibrated);
}

std::vector<DoiSlice> evaluate_slices(std::span<const double> depths_mm, std::span<const double> residuals,
                                      std::size_t slices) {
  std::vector<DoiSlice> evaluated;
  for (const DepthSlice& slice : slice_by_depth(depths_mm, residuals, slices, kLeastOfDoiSlice)) {
    core::Moments moments, fourth;
    const core::Estimate mean = mean_of(slice.values);
    for (const double value : slice.values) {
      const double distance = value - mean.value;
      moments.add(distance);
      fourth.add(distance * distance);
    }
    const double deviation = moments.standard_deviation();
    // The error of a variance follows from the spread of the squared distances, whatever the shape.
    const double error = deviation > 0.0 ? 0.5 * fourth.mean().error / deviation : 0.0;
    evaluated.push_back({slice.depth_mm,
                         slice.values.size(),
                         mean,
                         {core::kFwhmPerSigma * deviation, core::kFwhmPerSigma * error}});
  }
  return evaluated;
}

/// Depths and ratios of events: those that calibrate, and those that are evaluated.
struct EndEvents {
  std::array<std::vector<double>, 2> depths_mm, ratios;

  /// Without every 32nd, from `group` on.
  EndEvents without(std::size_t group) const {
    EndEvents rest;
    for (std::size_t half = 0; half < 2; ++half)
      for (std::size_t i = 0; i < ratios[half].size(); ++i) {
        if (i % kGroups == group) continue;
        rest.depths_mm[half].push_back(depths_mm[half][i]);
        rest.ratios[half].push_back(ratios[half][i]);
      }
    return rest;
  }
};

/// @param spread  makes the residuals' spread
DoiAnalysis evaluate(const EndEvents& events, DoiCalibrationKind kind, std::size_t slices,
                     Spread (*spread)(std::span<const double>)) {
  DoiAnalysis result;
  const Calibrated calibrated = line_of_means(events.depths_mm[0], events.ratios[0], 2 * slices);
  result.line = calibrated.line;
  result.calibration = calibration_of(calibrated, kind);
  std::vector<double> residuals_mm;
  for (std::size_t i = 0; i < events.ratios[1].size(); ++i)
    residuals_mm.push_back(result.calibration.depth(events.ratios[1][i]) - events.depths_mm[1][i]);
  result.residual = spread(residuals_mm);
  result.slices = evaluate_slices(events.depths_mm[1], residuals_mm, slices);
  return result;
}

/// Every number with an error, in a fixed order.
std::vector<core::Estimate*> estimates_of(DoiAnalysis& analysis) {
  std::vector<core::Estimate*> all{&analysis.residual.mean, &analysis.residual.quantile_fwhm};
  if (analysis.residual.fit.converged) all.push_back(&analysis.residual.gaussian_fwhm);
  for (DoiSlice& slice : analysis.slices) {
    all.push_back(&slice.bias_mm);
    all.push_back(&slice.fwhm_mm);
  }
  return all;
}

/// Errors that include those of the calibration: by the jackknife over groups of the events of both halves,
/// each calibrated and evaluated anew. Where a group leaves too few events for this, the errors are those of
/// the evaluated events alone.
void add_errors_of_calibration(const EndEvents& events, DoiCalibrationKind kind, std::size_t slices,
                               DoiAnalysis& analysis) {
  const std::vector<core::Estimate*> estimates = estimates_of(analysis);
  std::vector<std::vector<double>> left_out(estimates.size());
  for (std::size_t group = 0; group < kGroups; ++group) {
    DoiAnalysis without;
    try {
      without = evaluate(events.without(group), kind, slices, quick_spread_of);
    } catch (const core::InputError&) {
      return;
    }
    const std::vector<core::Estimate*> values = estimates_of(without);
    if (values.size() != estimates.size()) return;
    for (std::size_t k = 0; k < values.size(); ++k) left_out[k].push_back(values[k]->value);
  }
  for (std::size_t k = 0; k < estimates.size(); ++k) estimates[k]->error = core::jackknife_error(left_out[k]);
}

}  // namespace

double end_ratio(EndRatio kind, double a, double b) {
  if (!(a > 0.0) || !(b > 0.0)) return std::numeric_limits<double>::quiet_NaN();
  return kind == EndRatio::share ? a / (a + b) : std::log(a / b);
}

double DoiCalibration::depth(double at_ratio) const {
  const auto above =
      static_cast<std::size_t>(std::upper_bound(ratio.begin(), ratio.end(), at_ratio) - ratio.begin());
  const std::size_t i = std::clamp<std::size_t>(above, 1, ratio.size() - 1);
  return depth_mm[i - 1] +
         (at_ratio - ratio[i - 1]) / (ratio[i] - ratio[i - 1]) * (depth_mm[i] - depth_mm[i - 1]);
}

DoiCalibration calibrate_doi(std::span<const double> depths_mm, std::span<const double> ratios,
                             DoiCalibrationKind kind, std::size_t slices) {
  return calibration_of(line_of_means(depths_mm, ratios, slices), kind);
}

DoiAnalysis analyze_doi(std::span<const double> depths_mm, std::span<const double> ratios, EndRatio ratio,
                        DoiCalibrationKind kind, std::size_t slices) {
  EndEvents events;
  std::size_t usable = 0;
  for (std::size_t i = 0; i < std::min(depths_mm.size(), ratios.size()); ++i) {
    if (!std::isfinite(depths_mm[i]) || !std::isfinite(ratios[i])) continue;
    events.depths_mm[usable % 2].push_back(depths_mm[i]);
    events.ratios[usable % 2].push_back(ratios[i]);
    ++usable;
  }
  if (usable < kLeastWithBothEnds)
    throw no_doi(std::to_string(usable) + " events with light at both ends; " +
                     std::to_string(kLeastWithBothEnds) + " are needed",
                 "simulate more events");
  DoiAnalysis analysis = evaluate(events, kind, slices, spread_of);
  analysis.ratio = ratio;
  analysis.kind = kind;
  add_errors_of_calibration(events, kind, slices, analysis);
  return analysis;
}

}  // namespace scintray::analysis
