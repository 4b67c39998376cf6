#pragma once
/// Residuals of a measured and a simulated curve, each with its errors.

#include <Eigen/Core>
#include <vector>

#include "scintray/analysis/fit/measured_curve.hpp"
#include "scintray/core/statistics.hpp"

namespace scintray::analysis {

/// One point of a simulated curve.
struct ModelPoint {
  core::Estimate value;       ///< with its Monte Carlo error
  std::vector<double> parts;  ///< the same from equal shares of the photons, which are independent: their
                              ///< mean is the value. Empty: unknown
};
using ModelCurve = std::vector<ModelPoint>;

/// Residuals (y - s m) / sigma with sigma^2 = measurement error^2 + (s * Monte Carlo error)^2, s being 1 or
/// the scale that minimises their sum of squares. sigma is that of the curve last passed to `reweight`, so
/// that a search does not prefer curves with large errors.
class WeightedResiduals {
 public:
  WeightedResiduals(const MeasuredCurve& measured, bool free_scale);

  std::size_t size() const { return static_cast<std::size_t>(value_.size()); }
  bool free_scale() const { return free_scale_; }

  /// One measurement error for all points, replacing the file's.
  void set_common_error(double error);
  /// The common error with which the squares of the residuals of a curve sum to `degrees`; 0 when the Monte
  /// Carlo errors alone are larger than the scatter. Weights follow.
  double match_common_error(const ModelCurve& curve, double degrees);
  void reweight(const ModelCurve& curve);

  /// The scale with the current weights, in closed form: sum(w y m) / sum(w m^2).
  double scale(const ModelCurve& curve) const;
  Eigen::VectorXd of(const ModelCurve& curve) const;
  double chi2(const ModelCurve& curve) const { return of(curve).squaredNorm(); }
  /// Square roots of the weights, 1 / sigma.
  const Eigen::VectorXd& inverse_sigma() const { return inverse_sigma_; }
  /// Share of the Monte Carlo error in sigma^2 at each point.
  Eigen::VectorXd monte_carlo_share(const ModelCurve& curve) const;

 private:
  Eigen::VectorXd value_, error_, inverse_sigma_;
  bool free_scale_;
};

}  // namespace scintray::analysis
