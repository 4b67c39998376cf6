#pragma once
/// Text and tables of a fit, for a terminal and for its page.

#include <string>
#include <vector>

#include "scintray/analysis/fit/fit_record.hpp"

namespace scintray::report {

/// Rows of a table, the head first.
using TextTable = std::vector<std::vector<std::string>>;

/// Parameters of the result: start, value with its error, the part of the error that is Monte Carlo noise,
/// bounds.
TextTable fit_parameter_table(const analysis::FitRecord& record);
/// Correlations of the parameters; empty with one parameter or without errors.
TextTable fit_correlation_table(const analysis::FitRecord& record);
/// Measured, start, fitted and residual at each position.
TextTable fit_curve_table(const analysis::FitRecord& record);

/// "7 points, 2 parameters and a scale, 20 000 photons at each point of a curve, seed 1".
std::string fit_facts(const analysis::FitRecord& record);
/// Chi-square with degrees of freedom and p, or the error from the scatter.
std::string fit_goodness_text(const analysis::FitRecord& record);
/// Gain of precision by common random numbers; empty without Monte Carlo noise.
std::string fit_noise_text(const analysis::FitRecord& record);
/// End of the search, with its number of curves.
std::string fit_end_text(const analysis::FitRecord& record);

/// One line for a step of the search: "step 3: chi2 12.3, sigma 12.1 deg, ... (17 curves)".
std::string fit_step_text(const analysis::CurveFitStep& step,
                          const std::vector<scene_file::FitParameterSpec>& parameters, bool free_scale);

/// All parts of the text.
std::string fit_text(const analysis::FitRecord& record);

}  // namespace scintray::report
