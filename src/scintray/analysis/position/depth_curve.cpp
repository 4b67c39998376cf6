#include "scintray/analysis/position/depth_curve.hpp"

#include <gsl/gsl_fit.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "scintray/analysis/fit/detail/gsl_errors.hpp"
#include "scintray/analysis/position/detail/depth_slices.hpp"
#include "scintray/analysis/spectrum/photopeak.hpp"

namespace scintray::analysis {

namespace {

/// The photopeak's position of every slice; empty when one of them has no trusted one.
std::vector<core::Estimate> peak_positions(const std::vector<DepthSlice>& slices) {
  std::vector<core::Estimate> positions;
  for (const DepthSlice& slice : slices) {
    const Photopeak peak = fit_photopeak(slice.values);
    if (!peak.locates_peak()) return {};
    positions.push_back(peak.fit.position);
  }
  return positions;
}

/// Unweighted least squares, with the errors that those of the points propagate to. Light against depth is no
/// straight line: the line of a weighted fit would change with the weights, which fluctuate, too.
StraightLine even_line(const std::vector<double>& x, const std::vector<core::Estimate>& y) {
  const auto n = static_cast<double>(x.size());
  const double middle = std::accumulate(x.begin(), x.end(), 0.0) / n;
  double square = 0.0;
  for (const double at : x) square += (at - middle) * (at - middle);
  StraightLine line;
  double variance_offset = 0.0, variance_slope = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double of_slope = (x[i] - middle) / square, of_offset = 1.0 / n - middle * of_slope;
    const double variance = y[i].error * y[i].error;
    line.slope.value += of_slope * y[i].value;
    line.offset.value += of_offset * y[i].value;
    variance_slope += of_slope * of_slope * variance;
    variance_offset += of_offset * of_offset * variance;
    line.covariance += of_slope * of_offset * variance;
  }
  line.slope.error = std::sqrt(variance_slope);
  line.offset.error = std::sqrt(variance_offset);
  for (std::size_t i = 0; i < x.size(); ++i)
    line.goodness.chi2 +=
        std::pow((y[i].value - line.offset.value - line.slope.value * x[i]) / y[i].error, 2);
  line.goodness.degrees = n - 2.0;
  line.goodness.p_value = core::chi_square_p_value(line.goodness.chi2, line.goodness.degrees);
  return line;
}

}  // namespace

core::Estimate StraightLine::at(double x) const {
  return {offset.value + slope.value * x,
          std::sqrt(std::max(
              0.0, offset.error * offset.error + x * x * slope.error * slope.error + 2.0 * x * covariance))};
}

StraightLine fit_line(std::span<const double> x, std::span<const core::Estimate> y) {
  if (x.size() != y.size()) throw std::invalid_argument("a line needs as many x as y");
  if (x.empty() || std::all_of(x.begin(), x.end(), [&](double v) { return v == x.front(); }))
    throw std::invalid_argument("a line needs two different x");
  std::vector<double> values, weights;
  for (const core::Estimate& point : y) {
    if (!(point.error > 0.0)) throw std::invalid_argument("a line needs points with positive errors");
    values.push_back(point.value);
    weights.push_back(1.0 / (point.error * point.error));
  }
  silence_gsl();
  StraightLine line;
  double variance_offset = 0.0, variance_slope = 0.0;
  check_gsl(gsl_fit_wlinear(x.data(), 1, weights.data(), 1, values.data(), 1, x.size(), &line.offset.value,
                            &line.slope.value, &variance_offset, &line.covariance, &variance_slope,
                            &line.goodness.chi2),
            "fit of a line");
  line.offset.error = std::sqrt(variance_offset);
  line.slope.error = std::sqrt(variance_slope);
  line.goodness.degrees = static_cast<double>(x.size()) - 2.0;
  line.goodness.p_value = core::chi_square_p_value(line.goodness.chi2, line.goodness.degrees);
  return line;
}

DepthCurve depth_curve(std::vector<DepthPoint> points, double reference_mm) {
  if (points.empty()) throw std::invalid_argument("a depth curve needs points");
  for (const DepthPoint& point : points)
    if (!(point.value.value > 0.0) || !(point.value.error > 0.0))
      throw std::invalid_argument("a depth curve needs positive values and errors");
  DepthCurve curve;
  std::sort(points.begin(), points.end(),
            [](const DepthPoint& a, const DepthPoint& b) { return a.depth_mm < b.depth_mm; });
  curve.points = std::move(points);
  const auto distance = [&](const DepthPoint& point) { return std::abs(point.depth_mm - reference_mm); };
  curve.reference = static_cast<std::size_t>(
      std::min_element(curve.points.begin(), curve.points.end(),
                       [&](const DepthPoint& a, const DepthPoint& b) { return distance(a) < distance(b); }) -
      curve.points.begin());
  const core::Estimate reference = curve.points[curve.reference].value;
  std::vector<double> depths;
  std::vector<core::Estimate> values;
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    const core::Estimate value = curve.points[i].value;
    const double ratio = value.value / reference.value;
    const double error = ratio * std::hypot(value.error / value.value, reference.error / reference.value);
    curve.relative.push_back(i == curve.reference ? core::Estimate{1.0, 0.0} : core::Estimate{ratio, error});
    depths.push_back(curve.points[i].depth_mm);
    values.push_back(value);
  }
  if (depths.front() == depths.back()) return curve;
  curve.line = even_line(depths, values);
  const double middle = 0.5 * (depths.front() + depths.back());
  const core::Estimate centre = curve.line.at(middle);
  const double slope = curve.line.slope.value, relative = slope / centre.value;
  // Slope and value in the middle share their errors: cov(slope, offset + slope x) = cov + x var(slope).
  const double shared = curve.line.covariance + middle * curve.line.slope.error * curve.line.slope.error;
  const double variance = std::pow(curve.line.slope.error / centre.value, 2) +
                          std::pow(relative * centre.error / centre.value, 2) -
                          2.0 * relative * shared / (centre.value * centre.value);
  curve.relative_slope_per_mm = {relative, std::sqrt(std::max(0.0, variance))};
  return curve;
}

std::vector<DepthPoint> depth_points(std::span<const double> depths_mm, std::span<const double> values,
                                     std::size_t slices, std::size_t least) {
  const std::vector<DepthSlice> sliced = slice_by_depth(depths_mm, values, slices, least);
  const std::vector<core::Estimate> peaks = peak_positions(sliced);
  std::vector<DepthPoint> points;
  for (std::size_t i = 0; i < sliced.size(); ++i)
    points.push_back({sliced[i].depth_mm, sliced[i].values.size(),
                      peaks.empty() ? mean_of(sliced[i].values) : peaks[i], !peaks.empty()});
  return points;
}

}  // namespace scintray::analysis
