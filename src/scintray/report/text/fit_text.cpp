#include "scintray/report/text/fit_text.hpp"

#include <fmt/format.h>

#include "scintray/report/text/format.hpp"
#include "scintray/report/text/omissions.hpp"

namespace scintray::report {

namespace {

std::string with_unit(const std::string& text, const std::string& unit) {
  return unit.empty() ? text : text + " " + unit;
}

/// A fitted value with its error, or with its errors to both sides.
std::string fitted_text(const analysis::FittedParameter& p) {
  return p.parameter.variable == analysis::FitVariable::value
             ? with_error(p.value)
             : with_errors(p.value.value, p.interval_low, p.interval_high);
}

/// A measured value, whose error the file may not have.
std::string measured_text(const core::Estimate& value) {
  return value.error > 0.0 ? with_error(value) : compact(value.value, 5);
}

/// A point of the simulation on the scale of the measurement.
std::string scaled_text(const analysis::ModelPoint& point, double scale) {
  return with_error({scale * point.value.value, scale * point.value.error});
}

}  // namespace

TextTable fit_parameter_table(const analysis::FitRecord& record) {
  const analysis::CurveFit& fit = record.fit;
  TextTable table{{"parameter", "start", "fitted", "of it Monte Carlo", "bounds"}};
  for (std::size_t j = 0; j < fit.parameters.size(); ++j) {
    const analysis::FittedParameter& p = fit.parameters[j];
    const std::string& unit = record.spec.parameters[j].unit;
    table.push_back({p.parameter.name, with_unit(compact(p.parameter.start, 6), unit),
                     with_unit(fit.has_errors ? fitted_text(p) : compact(p.value.value, 6), unit),
                     fit.has_errors ? with_unit(compact(p.monte_carlo_error, 2), unit) : "-",
                     with_unit(compact(p.parameter.low, 6) + " to " + compact(p.parameter.high, 6), unit)});
  }
  if (record.spec.free_scale)
    table.push_back({"scale", compact(fit.start_scale, 6),
                     fit.has_errors ? with_error(fit.scale) : compact(fit.scale.value, 6), "", "free"});
  return table;
}

TextTable fit_correlation_table(const analysis::FitRecord& record) {
  const analysis::CurveFit& fit = record.fit;
  if (!fit.has_errors || fit.parameters.size() < 2) return {};
  TextTable table{{"correlation"}};
  for (const analysis::FittedParameter& p : fit.parameters) table.front().push_back(p.parameter.name);
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    table.push_back({fit.parameters[i].parameter.name});
    for (std::size_t j = 0; j < fit.parameters.size(); ++j)
      table.back().push_back(
          fixed(fit.correlation(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)), 3));
  }
  return table;
}

TextTable fit_curve_table(const analysis::FitRecord& record) {
  const analysis::CurveFit& fit = record.fit;
  TextTable table{{with_unit("at", record.spec.unit), "measured", "start", "fitted", "residual / error"}};
  for (std::size_t i = 0; i < fit.curve.size(); ++i)
    table.push_back({compact(record.measured.points[i].x, 6), measured_text(record.measured.points[i].y),
                     scaled_text(fit.start_curve[i], fit.start_scale),
                     scaled_text(fit.curve[i], fit.scale.value), fixed(fit.residual[i], 2)});
  return table;
}

std::string fit_facts(const analysis::FitRecord& record) {
  const std::size_t parameters = record.spec.parameters.size();
  return fmt::format("{} points, {} parameter{}, {}, {} {} at each point of a curve, seed {}",
                     record.measured.points.size(), parameters, parameters == 1 ? "" : "s",
                     record.spec.free_scale ? "a free scale" : "no scale", record.traced, record.thing,
                     record.seed);
}

std::string fit_goodness_text(const analysis::FitRecord& record) {
  const analysis::CurveFit& fit = record.fit;
  if (fit.common_error)
    return fmt::format(
        "{} degrees of freedom; the error of a measured value, found from the scatter, is {:.3g}, so "
        "chi-square holds no information",
        fit.goodness.degrees, *fit.common_error);
  if (!(fit.goodness.degrees > 0.0)) return "there are no degrees of freedom to test the fit";
  return fmt::format("chi-square {:.2f} for {} degrees of freedom, p = {:.3g}", fit.goodness.chi2,
                     fit.goodness.degrees, fit.goodness.p_value);
}

std::string fit_noise_text(const analysis::FitRecord& record) {
  if (!record.fit.has_errors || record.fit.variance_ratio == 1.0) return "";
  return fmt::format(
      "common random numbers: differences of curves have {:.2g} times less variance than with "
      "independent ones",
      record.fit.variance_ratio);
}

std::string fit_end_text(const analysis::FitRecord& record) {
  const analysis::CurveFit& fit = record.fit;
  const char* how = fit.end == analysis::FitEnd::converged ? "converged"
                    : fit.end == analysis::FitEnd::stopped ? "stopped by the user: the best so far"
                                                           : "not converged";
  const std::size_t curves = fit.steps.empty() ? 0 : fit.steps.back().evaluations;
  return fmt::format("{} after {} steps and {} curves, {:.3g} s", how,
                     fit.steps.empty() ? 0 : fit.steps.size() - 1, curves, record.wall_seconds);
}

std::string fit_step_text(const analysis::CurveFitStep& step,
                          const std::vector<scene_file::FitParameterSpec>& parameters, bool free_scale) {
  std::string text = step.number == 0 ? "start " : fmt::format("step {}", step.number);
  text += fmt::format("  chi-square {:>9.2f}", step.chi2);
  for (std::size_t j = 0; j < parameters.size(); ++j)
    text += fmt::format(", {} {}", parameters[j].label,
                        with_unit(compact(step.parameters[j], 5), parameters[j].unit));
  if (free_scale) text += fmt::format(", scale {:.5g}", step.scale);
  return step.estimate ? text + " (new random numbers)" : text;
}

std::string fit_text(const analysis::FitRecord& record) {
  std::string text = record.title.empty() ? "" : record.title + "\n";
  text += fmt::format("fit of the {} to {}\n{}\n{}\n\n", analysis::quantity_words(record.spec.quantity),
                      record.spec.measurement.filename().string(), fit_facts(record), fit_end_text(record));
  text += aligned(fit_parameter_table(record));
  if (!record.fit.has_errors) text += "  (stopped before their errors were known)\n";
  if (const TextTable correlation = fit_correlation_table(record); !correlation.empty())
    text += "\n" + aligned(correlation);
  text += "\n" + fit_goodness_text(record) + "\n";
  if (const std::string noise = fit_noise_text(record); !noise.empty()) text += noise + "\n";
  text += "\n" + aligned(fit_curve_table(record)) + "\n";
  if (record.omitted) text += omission_sentence(record.omitted, Figure::fraction) + "\n";
  for (const std::string& note : record.notes) text += "note: " + note + "\n";
  for (const std::string& warning : record.fit.warnings) text += "warning: " + warning + "\n";
  return text;
}

}  // namespace scintray::report
