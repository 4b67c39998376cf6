#include "scintray/analysis/fit/fit_residuals.hpp"

#include <cmath>

namespace scintray::analysis {

namespace {

Eigen::VectorXd values_of(const ModelCurve& curve) {
  Eigen::VectorXd values(static_cast<Eigen::Index>(curve.size()));
  for (std::size_t i = 0; i < curve.size(); ++i) values[static_cast<Eigen::Index>(i)] = curve[i].value.value;
  return values;
}

Eigen::VectorXd errors_of(const ModelCurve& curve) {
  Eigen::VectorXd errors(static_cast<Eigen::Index>(curve.size()));
  for (std::size_t i = 0; i < curve.size(); ++i) errors[static_cast<Eigen::Index>(i)] = curve[i].value.error;
  return errors;
}

}  // namespace

WeightedResiduals::WeightedResiduals(const MeasuredCurve& measured, bool free_scale)
    : value_(static_cast<Eigen::Index>(measured.points.size())),
      error_(value_.size()),
      free_scale_(free_scale) {
  for (Eigen::Index i = 0; i < value_.size(); ++i) {
    value_[i] = measured.points[static_cast<std::size_t>(i)].y.value;
    error_[i] = measured.points[static_cast<std::size_t>(i)].y.error;
  }
  inverse_sigma_ = Eigen::VectorXd::Ones(value_.size());
}

void WeightedResiduals::set_common_error(double error) { error_.setConstant(error); }

double WeightedResiduals::match_common_error(const ModelCurve& curve, double degrees) {
  const auto chi2_with = [&](double error) {
    set_common_error(error);
    reweight(curve);
    return chi2(curve);
  };
  // Wide enough for any curve: the residuals without a curve are the values themselves.
  double low = 1e-9 * value_.norm(), high = value_.norm();
  if (chi2_with(low) < degrees) {
    set_common_error(0.0);
    reweight(curve);
    return 0.0;
  }
  constexpr int kHalvings = 60;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = std::sqrt(low * high);
    (chi2_with(middle) > degrees ? low : high) = middle;
  }
  chi2_with(high);
  return high;
}

void WeightedResiduals::reweight(const ModelCurve& curve) {
  const Eigen::VectorXd model_error = errors_of(curve);
  // The scale depends on the errors and the errors on the scale: both converge in a few iterations.
  constexpr int kRounds = 20;
  for (int round = 0; round < kRounds; ++round) {
    const double s = scale(curve);
    const Eigen::ArrayXd variance = error_.array().square() + (s * model_error).array().square();
    const Eigen::VectorXd before = inverse_sigma_;
    inverse_sigma_ = variance.max(1e-300).rsqrt().matrix();
    if ((inverse_sigma_ - before).norm() < 1e-12 * inverse_sigma_.norm()) return;
  }
}

double WeightedResiduals::scale(const ModelCurve& curve) const {
  if (!free_scale_) return 1.0;
  const Eigen::VectorXd model = inverse_sigma_.cwiseProduct(values_of(curve));
  const double square = model.squaredNorm();
  return square > 0.0 ? model.dot(inverse_sigma_.cwiseProduct(value_)) / square : 1.0;
}

Eigen::VectorXd WeightedResiduals::of(const ModelCurve& curve) const {
  return inverse_sigma_.cwiseProduct(value_ - scale(curve) * values_of(curve));
}

Eigen::VectorXd WeightedResiduals::monte_carlo_share(const ModelCurve& curve) const {
  return (scale(curve) * errors_of(curve)).cwiseProduct(inverse_sigma_).array().square().min(1.0).matrix();
}

}  // namespace scintray::analysis
