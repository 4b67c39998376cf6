#pragma once
/// Tabulated functions of one variable: indices, efficiencies, spectra against wavelength.

#include <string>
#include <vector>

namespace scintray::core {

/// y(x) by linear interpolation between tabulated points; a single point is a constant.
///
/// Evaluation outside the table returns the nearest end value: the builder of a scene checks the range first
/// (`covers`), so that nothing is extrapolated silently.
class Curve {
 public:
  Curve() = default;
  /// x strictly increasing, same length as y, at least one point, all finite; else InputError.
  Curve(std::vector<double> x, std::vector<double> y);
  static Curve constant(double value);

  double operator()(double x) const;
  /// Slope dy/dx of the piecewise-linear curve smoothed by central differences at the points.
  double derivative(double x) const;

  bool is_constant() const { return x_.size() <= 1; }
  /// True when [low, high] lies in the table, or the curve is a constant.
  bool covers(double low, double high) const;
  const std::vector<double>& x() const { return x_; }
  const std::vector<double>& y() const { return y_; }
  double min_y() const;
  double max_y() const;

 private:
  std::vector<double> x_{0.0};
  std::vector<double> y_{0.0};
};

/// Samples x with density proportional to a non-negative curve (inverse of its exact integral).
class CurveSampler {
 public:
  CurveSampler() = default;
  /// Throws InputError when a value is negative or the integral is zero.
  explicit CurveSampler(const Curve& density);
  /// x for a uniform number u in [0, 1).
  double sample(double u) const;
  /// Cumulative distribution at x, in [0, 1]: the inverse of `sample`.
  double share_below(double x) const;
  double mean() const;

 private:
  std::vector<double> x_, y_, cumulative_;
};

}  // namespace scintray::core
