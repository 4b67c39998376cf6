#pragma once
/// Fit of a simulated curve, which is noisy, to a measured one.

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scintray/analysis/fit/fit_residuals.hpp"
#include "scintray/scene_file/fit.hpp"

namespace scintray::analysis {

using scene_file::FitVariable;

struct FitParameter {
  std::string name;
  double start = 0.0, low = 0.0, high = 0.0;  ///< low < start < high, for the inverse above 0
  FitVariable variable = FitVariable::value;
};

/// The simulated curve at given parameters, one point for each measured one; empty when it was stopped.
/// Curves of one draw should come from the same random numbers, so that differences between nearby parameters
/// are more precise than curves (common random numbers: A. M. Law 2015, Simulation Modeling and Analysis, 5th
/// edition, section 11.2); curves of different draws from different ones.
using CurveModel =
    std::function<std::optional<ModelCurve>(const std::vector<double>& parameters, std::uint64_t draw)>;

/// State of the search after a step.
struct CurveFitStep {
  std::size_t number = 0;       ///< 0: the start
  std::size_t evaluations = 0;  ///< curves traced so far
  std::vector<double> parameters;
  double scale = 1.0, chi2 = 0.0;
  bool estimate = false;  ///< by new random numbers, with which chi-square starts again
};

struct CurveFitOptions {
  bool free_scale = false;           ///< the curve may be multiplied by a factor, which is fitted
  bool errors_from_scatter = false;  ///< one unknown error for all points, found from the residuals
  std::size_t most_steps = 60;
  std::function<void(const CurveFitStep&)> progress;
};

enum class FitEnd { converged, not_converged, stopped };

/// Errors and intervals are NaN without CurveFit::has_errors.
struct FittedParameter {
  FitParameter parameter;
  core::Estimate value;            ///< the error includes all contributions; for the inverse to first order
  double monte_carlo_error = 0.0;  ///< part of it from the simulation, which decreases with more photons
  core::Estimate variable;         ///< the value or its inverse, with one standard error of it
  /// Of the value, at one standard error of the variable to both sides, or at the bounds if they are nearer.
  double interval_low = 0.0, interval_high = 0.0;
  bool at_low = false, at_high = false;
  bool determined = true;  ///< false: the error is that of a uniform distribution between the bounds
};

struct CurveFit {
  FitEnd end = FitEnd::stopped;
  bool has_errors = false;  ///< false: stopped before they were computed
  std::vector<FittedParameter> parameters;
  Eigen::MatrixXd correlation;         ///< of the parameters
  core::Estimate scale{1.0, 0.0};      ///< error: with the parameters fitted along
  double start_scale = 1.0;            ///< best scale of the curve at the start
  std::optional<double> common_error;  ///< of a measured value, found from the scatter
  /// Of the simulation, not scaled; that of the result is extrapolated by slopes from less than a standard
  /// error away (from the random numbers of the estimate).
  ModelCurve start_curve, curve;
  std::vector<double> error;     ///< of each residual: measurement and Monte Carlo
  std::vector<double> residual;  ///< (measured - scale * curve) / error
  core::ChiSquare goodness;      ///< without degrees of freedom, or with common_error, p is not defined
  double variance_ratio = 1.0;   ///< of differences, independent over common random numbers
  std::vector<CurveFitStep> steps;
  std::vector<std::string> warnings;  ///< warnings for the user
};

/// Least squares by GSL's trust region method (Levenberg-Marquardt; gsl_multifit_nlinear) with these
/// additions for a noisy curve:
///  - every parameter is searched in its FitVariable;
///  - parameters are kept within their bounds by p = low + (high - low) (1 + sin x) / 2 (F. James and M. Roos
///    1975, Comput. Phys. Commun. 10, 343);
///  - slopes are central differences over about one standard error of the parameter to each side, and over
///    more where the measured noise of a difference is above a tenth of it;
///  - weights contain the Monte Carlo errors in quadrature and are fixed during a search, which is repeated
///    until they converge;
///  - it ends where chi-square is expected to decrease by less than a tenth, or where it no longer decreases:
///    the steps then follow the noise of the curve;
///  - a search converges where the noise happens to agree with the measurement; so the estimate is a
///    Gauss-Newton step from there with other random numbers, whose residuals have the statistics of a fit;
///  - errors: see covariance_of. The scale is eliminated (G. H. Golub and V. Pereyra 1973, SIAM J. Numer.
///    Anal. 10, 413).
/// Deterministic for a deterministic model. @throws InputError for fewer points than parameters (and one more
/// for a scale, and for errors from the scatter), for a start that is not within its bounds, for an inverse
/// with bounds that are not above 0, or when the curve has no light anywhere at the start;
/// std::invalid_argument when the model returns another number of points.
CurveFit fit_curve(const MeasuredCurve& measured, const std::vector<FitParameter>& parameters,
                   const CurveModel& model, const CurveFitOptions& options = {});

}  // namespace scintray::analysis
