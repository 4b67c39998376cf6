#include "scintray/analysis/fit/curve_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "scintray/analysis/fit/detail/fit_information.hpp"
#include "scintray/analysis/fit/detail/fit_search.hpp"
#include "scintray/core/error.hpp"

namespace scintray::analysis {

namespace {

using Eigen::Index;

/// Correlation above which only a combination of two parameters is determined.
constexpr double kSameDirection = 0.98;
constexpr double kLeastProbability = 1e-3;
/// Of errors until they are computed.
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// From a value to its variable, or back.
double converted(const FitParameter& parameter, double value) {
  return parameter.variable == FitVariable::inverse ? 1.0 / value : value;
}

/// The parameters by their variables.
std::vector<FitParameter> variables_of(const std::vector<FitParameter>& parameters) {
  std::vector<FitParameter> variables = parameters;
  for (FitParameter& p : variables) {
    p = {p.name, converted(p, p.start), converted(p, p.low), converted(p, p.high), p.variable};
    if (p.low > p.high) std::swap(p.low, p.high);
  }
  return variables;
}

std::vector<double> values_of(const std::vector<FitParameter>& parameters,
                              const std::vector<double>& variables) {
  std::vector<double> values;
  for (std::size_t j = 0; j < parameters.size(); ++j)
    values.push_back(
        std::clamp(converted(parameters[j], variables[j]), parameters[j].low, parameters[j].high));
  return values;
}

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
    else if (p.variable == FitVariable::inverse && !(p.low > 0.0))
      problems.add({}, fmt::format("the inverse of {} is fitted, but its lower bound is {:g}", p.name, p.low),
                   "give a lower bound above 0, or fit the value itself");
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

void add_warnings(CurveFit& fit, const std::vector<FitParameter>& variables,
                  const Eigen::VectorXd& noise_share, bool errors_from_scatter) {
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
          fmt::format("the measurement does not determine {}: the error{}, {:.3g}, is as large as that of "
                      "a uniform distribution between {:g} and {:g}",
                      name, p.parameter.variable == FitVariable::inverse ? " of its inverse" : "",
                      p.variable.error, variables[j].low, variables[j].high));
    else if (p.monte_carlo_error * p.monte_carlo_error > 0.5 * p.value.error * p.value.error)
      warn(
          fmt::format("more than half of the variance of {} is Monte Carlo noise: more photons would make it "
                      "surer",
                      name));
    const auto k = static_cast<Index>(j);
    if (p.determined && noise_share[k] > 0.1)
      warn(fmt::format("the slope of the curve by {} is known to {:.0f} % only: use more photons", name,
                       100.0 * std::sqrt(noise_share[k])));
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

void set_parameters(CurveFit& fit, const std::vector<FitParameter>& parameters,
                    const std::vector<FitParameter>& variables, const FitSearch& search) {
  const std::vector<double> values = values_of(parameters, search.best());
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    FittedParameter p;
    p.parameter = parameters[j];
    p.value = {values[j], kUnknown};
    p.variable = {search.best()[j], kUnknown};
    p.monte_carlo_error = p.interval_low = p.interval_high = kUnknown;
    const double margin = kAtBound * (variables[j].high - variables[j].low);
    p.at_low = p.variable.value <= variables[j].low + margin;
    p.at_high = p.variable.value >= variables[j].high - margin;
    if (p.parameter.variable == FitVariable::inverse) std::swap(p.at_low, p.at_high);
    fit.parameters.push_back(std::move(p));
  }
}

/// The errors of a parameter, from those of its variable.
void set_error(FittedParameter& p, const FitParameter& variable, double error, double monte_carlo_error) {
  p.variable.error = error;
  const double low = std::max(variable.low, p.variable.value - error);
  const double high = std::min(variable.high, p.variable.value + error);
  std::tie(p.interval_low, p.interval_high) =
      std::minmax({converted(variable, low), converted(variable, high)});
  const double slope = p.parameter.variable == FitVariable::inverse ? std::pow(p.value.value, 2) : 1.0;
  p.value.error = slope * error;
  p.monte_carlo_error = slope * monte_carlo_error;
  // The standard deviation of a uniform distribution over the range.
  p.determined = error < (variable.high - variable.low) / std::sqrt(12.0);
}

/// Sign of the change of a parameter by its variable.
Eigen::VectorXd signs_of(const std::vector<FitParameter>& parameters) {
  Eigen::VectorXd signs(static_cast<Index>(parameters.size()));
  for (std::size_t j = 0; j < parameters.size(); ++j)
    signs[static_cast<Index>(j)] = parameters[j].variable == FitVariable::inverse ? -1.0 : 1.0;
  return signs;
}

void set_errors(CurveFit& fit, const std::vector<FitParameter>& variables, const FitSearch& search,
                bool errors_from_scatter) {
  const FitSlopes& slopes = *search.slopes();
  const WeightedResiduals& residuals = search.residuals();
  const FitCovariance covariance =
      covariance_of(slopes, search.range(), search.estimates(), residuals.of(fit.curve),
                    residuals.monte_carlo_share(fit.curve));
  fit.has_errors = true;
  const Eigen::VectorXd sigma = covariance.total.diagonal().cwiseSqrt();
  const Eigen::VectorXd unit = signs_of(variables).cwiseQuotient(sigma);
  fit.correlation = unit.asDiagonal() * covariance.total * unit.asDiagonal();
  for (std::size_t j = 0; j < fit.parameters.size(); ++j) {
    const auto k = static_cast<Index>(j);
    set_error(fit.parameters[j], variables[j], sigma[k], std::sqrt(std::max(0.0, covariance.monte_carlo[k])));
  }
  fit.scale.error = scale_error(search, covariance, fit.curve);
  if (slopes.common_variance > 0.0) fit.variance_ratio = slopes.independent_variance / slopes.common_variance;
  const Eigen::VectorXd noise_share =
      slopes.summed_noise().diagonal().cwiseQuotient(information_of(slopes, search.range()).diagonal());
  add_warnings(fit, variables, noise_share, errors_from_scatter);
}

}  // namespace

CurveFit fit_curve(const MeasuredCurve& measured, const std::vector<FitParameter>& parameters,
                   const CurveModel& model, const CurveFitOptions& options) {
  check(measured, parameters, options);
  const std::vector<FitParameter> variables = variables_of(parameters);
  const CurveModel by_variables = [&](const std::vector<double>& at, std::uint64_t draw) {
    return model(values_of(parameters, at), draw);
  };
  CurveFit fit;
  CurveFitOptions searching = options;
  searching.progress = [&](const CurveFitStep& step) {
    fit.steps.push_back(step);
    fit.steps.back().parameters = values_of(parameters, step.parameters);
    if (options.progress) options.progress(fit.steps.back());
  };
  FitSearch search(measured, variables, by_variables, searching);
  fit.end = search.run();
  set_parameters(fit, parameters, variables, search);
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
  if (search.slopes()) set_errors(fit, variables, search, options.errors_from_scatter);
  return fit;
}

}  // namespace scintray::analysis
