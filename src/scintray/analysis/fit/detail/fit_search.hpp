#pragma once
/// The search for the least squares of a noisy curve, as described in curve_fit.hpp.

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "scintray/analysis/fit/curve_fit.hpp"
#include "scintray/analysis/fit/detail/fit_information.hpp"

namespace scintray::analysis {

/// Distance from a bound, as a share of the range, within which a parameter counts as at the bound (chosen).
inline constexpr double kAtBound = 1e-3;

class FitSearch {
 public:
  FitSearch(const MeasuredCurve& measured, const std::vector<FitParameter>& parameters,
            const CurveModel& model, const CurveFitOptions& options);

  FitEnd run();

  const std::vector<double>& best() const { return best_; }
  /// Curve at the best point: traced, or extrapolated by slopes from nearby. Empty when the first one was
  /// stopped.
  const std::optional<ModelCurve>& curve() const { return curve_; }
  const ModelCurve& start_curve() const { return start_curve_; }
  /// Derivatives at the point of the estimate; empty when stopped before they were computed.
  const std::optional<FitSlopes>& slopes() const { return slopes_; }
  /// Derivatives of the scale by the parameters there.
  const Eigen::VectorXd& scale_slopes() const { return scale_slopes_; }
  const WeightedResiduals& residuals() const { return residuals_; }
  const std::optional<double>& common_error() const { return common_error_; }
  Eigen::VectorXd range() const;
  /// Steps of the estimate, with other random numbers than the search.
  std::size_t estimates() const { return estimates_; }
  /// Degrees of freedom: points minus fitted quantities.
  double degrees() const;

 private:
  friend struct GslFunctions;
  /// Newton's step with the current slopes.
  struct Outlook {
    Eigen::VectorXd step;
    double fall = 0.0;  ///< expected decrease of chi-square
  };

  std::optional<ModelCurve> evaluate(const std::vector<double>& at);
  std::optional<ModelCurve> trace(const std::vector<double>& at, std::uint64_t draw);
  bool find_slopes(const std::vector<double>& at);
  bool repeat_slopes();
  void set_slopes(const ModelCurve& centre, std::vector<DifferencePair> pairs);
  /// Both ends of the difference in a parameter.
  std::array<std::vector<double>, 2> sides_of(const std::vector<double>& at, std::size_t j) const;
  void choose_spans();
  Outlook outlook() const;
  void update_weights();
  void descend();
  bool estimate();
  void accept_best_known();
  ModelCurve carried_on(const std::vector<double>& to) const;
  void accept(const std::vector<double>& at);
  void report_step();
  std::vector<double> outer(const double* inner) const;
  double snapped(std::size_t parameter, double value) const;
  double inner(std::size_t parameter, double value) const;
  double inner_slope(std::size_t parameter, double value) const;

  std::vector<FitParameter> parameters_;
  const CurveModel& model_;
  const CurveFitOptions& options_;
  WeightedResiduals residuals_;
  std::map<std::vector<double>, ModelCurve> known_;
  std::vector<double> best_, slopes_at_;
  std::optional<ModelCurve> curve_;
  ModelCurve start_curve_;
  std::vector<double> span_;           ///< to each side, of each parameter's differences
  std::vector<double> wider_;          ///< factor on one standard error, for the noise
  std::vector<DifferencePair> pairs_;  ///< from which the slopes are computed
  std::optional<FitSlopes> slopes_;
  Eigen::VectorXd scale_slopes_;
  std::optional<double> common_error_;
  std::size_t steps_ = 0, evaluations_ = 0, estimates_ = 0;
  int trials_ = 0;
  std::uint64_t draw_ = 0;  ///< of random numbers: 0 to search, 1 to estimate, above for slopes alone
  bool converged_ = false;
  bool stopped_ = false;
};

}  // namespace scintray::analysis
