#include "scintray/analysis/fit/curve_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scintray/analysis/fit/detail/fit_information.hpp"
#include "scintray/analysis/fit/detail/fit_search.hpp"
#include "scintray/core/error.hpp"

namespace scintray::analysis {

namespace {

using Eigen::Index;

/// Correlation above which only a combination of two parameters is determined.
constexpr double kSameDirection = 0.98;
constexpr double kLeastProbability = 1e-3;

void check(const MeasuredCurve& measured, const std::vector<FitParameter>& parameters,
           const CurveFitOptions& options) {
  core::Problems problems;
  if (parameters.empty()) problems.add({}, "a fit without parameters", "define at least one");
  for (const FitParameter& p : parameters)
    if (!(p.low < p.start && p.start < p.high))
      problems.add({},
                   fmt::format("the start of {}, {:g}, does not lie between {:g} and {:g}", p.name, p.start,
                               p.low, p.high),
                   "start within the bounds, not on them");
  const std::size_t needed =
      parameters.size() + (options.free_scale ? 1 : 0) + (options.errors_from_scatter ? 1 : 0);
  if (measured.points.size() < needed) {
    std::string what = fmt::format("{} parameters", parameters.size());
    if (options.free_scale) what += ", a scale";
    if (options.errors_from_scatter) what += ", an error from the scatter";
    const core::FileLocation where = measured.points.empty()
                                         ? core::FileLocation{}
                                         : core::FileLocation{measured.points.front().where.file, 0, 0};
    problems.add(
        where,
        fmt::format("{} measured points; expected {} at least, for {}", measured.points.size(), needed, what),
        "measure more points, or fit fewer parameters");
  }
  if (!measured.has_errors && !options.errors_from_scatter)
    problems.add({}, "the measured values have no errors", "give them, or find one from the scatter");
  problems.throw_if_any();
}

void add_warnings(CurveFit& fit, const Eigen::MatrixXd& slope_noise, const Eigen::MatrixXd& information,
                  bool errors_from_scatter) {
  const auto warn = [&](std::string text) { fit.warnings.push_back(std::move(text)); };
  for (std::size_t j = 0; j < fit.parameters.size(); ++j) {
    const FittedParameter& p = fit.parameters[j];
    const std::string& name = p.parameter.name;
    if (p.at_low || p.at_high)
      warn(
          fmt::format("{} is at its {} bound, {:g}: the best value may be beyond it, and its error is not "
                      "that of a free parameter",
                      name, p.at_low ? "lower" : "upper", p.at_low ? p.parameter.low : p.parameter.high));
    if (!p.determined)
      warn(
          fmt::format("the measurement does not determine {}: its error, {:.3g}, is as large as that of "
                      "a uniform distribution between {:g} and {:g}",
                      name, p.value.error, p.parameter.low, p.parameter.high));
    else if (p.monte_carlo_error * p.monte_carlo_error > 0.5 * p.value.error * p.value.error)
      warn(
          fmt::format("more than half of the variance of {} is Monte Carlo noise: more photons would make it "
                      "surer",
                      name));
    const auto k = static_cast<Index>(j);
    if (p.determined && slope_noise(k, k) > 0.1 * information(k, k))
      warn(fmt::format("the slope of the curve by {} is known to {:.0f} % only: use more photons", name,
                       100.0 * std::sqrt(slope_noise(k, k) / information(k, k))));
    for (std::size_t other = 0; other < j; ++other) {
      const double correlation = fit.correlation(k, static_cast<Index>(other));
      if (std::abs(correlation) > kSameDirection)
        warn(
            fmt::format("{} and {} have a correlation of {:.4f}: the measurement determines a combination of "
                        "the two, hardly each of them",
                        fit.parameters[other].parameter.name, name, correlation));
    }
  }
  if (fit.end == FitEnd::not_converged)
    warn(
        "the search did not converge: the result is the best point found. Start nearer, narrow the "
        "bounds, "
        "or use more photons");
  if (!errors_from_scatter && fit.goodness.degrees > 0.0 && fit.goodness.p_value < kLeastProbability)
    warn(
        "the fitted curve does not describe the measurement within its errors, so the errors of the "
        "parameters, "
        "which assume a correct model, are too small");
}

/// The scale's own error and its part from the parameters.
double scale_error(const FitSearch& search, const FitCovariance& covariance, const ModelCurve& curve) {
  const WeightedResiduals& residuals = search.residuals();
  if (!residuals.free_scale()) return 0.0;
  double square = 0.0;
  for (std::size_t i = 0; i < curve.size(); ++i)
    square += std::pow(residuals.inverse_sigma()[static_cast<Index>(i)] * curve[i].value.value, 2);
  if (!(square > 0.0)) return 0.0;
  const Eigen::VectorXd by = search.scale_slopes();
  return std::sqrt(1.0 / square + by.dot(covariance.total * by));
}

void set_parameters(CurveFit& fit, const std::vector<FitParameter>& parameters, const FitSearch& search) {
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    FittedParameter p;
    p.parameter = parameters[j];
    p.value.value = search.best()[j];
    const double margin = kAtBound * (p.parameter.high - p.parameter.low);
    p.at_low = p.value.value <= p.parameter.low + margin;
    p.at_high = p.value.value >= p.parameter.high - margin;
    fit.parameters.push_back(std::move(p));
  }
}

void set_errors(CurveFit& fit, const FitSearch& search, bool errors_from_scatter) {
  const FitSlopes& slopes = *search.slopes();
  const WeightedResiduals& residuals = search.residuals();
  const Eigen::MatrixXd information = information_of(slopes, search.range());
  const FitCovariance covariance =
      covariance_of(slopes, information, residuals.of(fit.curve), residuals.monte_carlo_share(fit.curve));
  fit.has_errors = true;
  const Eigen::VectorXd sigma = covariance.total.diagonal().cwiseSqrt();
  fit.correlation = sigma.cwiseInverse().asDiagonal() * covariance.total * sigma.cwiseInverse().asDiagonal();
  for (std::size_t j = 0; j < fit.parameters.size(); ++j) {
    FittedParameter& p = fit.parameters[j];
    p.value.error = sigma[static_cast<Index>(j)];
    p.monte_carlo_error = std::sqrt(std::max(0.0, covariance.monte_carlo[static_cast<Index>(j)]));
    // The standard deviation of a uniform distribution over the range.
    p.determined = p.value.error < (p.parameter.high - p.parameter.low) / std::sqrt(12.0);
  }
  fit.scale.error = scale_error(search, covariance, fit.curve);
  if (slopes.common_variance > 0.0) fit.variance_ratio = slopes.independent_variance / slopes.common_variance;
  add_warnings(fit, slopes.summed_noise(), information, errors_from_scatter);
}

}  // namespace

CurveFit fit_curve(const MeasuredCurve& measured, const std::vector<FitParameter>& parameters,
                   const CurveModel& model, const CurveFitOptions& options) {
  check(measured, parameters, options);
  FitSearch search(measured, parameters, model, options);
  CurveFit fit;
  fit.end = search.run();
  fit.steps = search.steps();
  set_parameters(fit, parameters, search);
  if (!search.curve()) return fit;
  const WeightedResiduals& residuals = search.residuals();
  fit.start_curve = search.start_curve();
  fit.curve = *search.curve();
  fit.start_scale = residuals.scale(fit.start_curve);
  fit.scale.value = residuals.scale(fit.curve);
  fit.common_error = search.common_error();
  const Eigen::VectorXd residual = residuals.of(fit.curve);
  for (Index i = 0; i < residual.size(); ++i) {
    fit.error.push_back(1.0 / residuals.inverse_sigma()[i]);
    fit.residual.push_back(residual[i]);
  }
  fit.goodness.chi2 = residual.squaredNorm();
  fit.goodness.degrees = search.degrees();
  if (fit.goodness.degrees > 0.0)
    fit.goodness.p_value = core::chi_square_p_value(fit.goodness.chi2, fit.goodness.degrees);
  if (search.slopes()) set_errors(fit, search, options.errors_from_scatter);
  return fit;
}

}  // namespace scintray::analysis
