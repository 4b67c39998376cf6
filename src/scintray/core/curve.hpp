#pragma once
/// Tabulated functions of one variable: indices, efficiencies, spectra against wavelength.

#include <cstdint>
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

/// Samples x with density proportional to a non-negative curve (inverse of its exact integral). The interval
/// is found by a guide table (SciPy's documentation, "Discrete Guide Table (DGT)"), and is that of a search.
class CurveSampler {
 public:
  CurveSampler() = default;
  /// Throws InputError when a value is negative or the integral is zero.
  explicit CurveSampler(const Curve& density);
  /// x for a uniform number u in [0, 1).
  double sample(double u) const;
  /// Cumulative distribution at x, in [0, 1]: the inverse of `sample`.
  double share_below(double x) const;
  double mean() const { return mean_; }

 private:
  /// From one point of the curve to the next.
  struct Interval {
    double below = 0.0;           ///< integral up to the interval
    double x = 0.0, width = 0.0;  ///< its start, and its length
    double y = 0.0, step = 0.0;   ///< the density at its start, and from there to its end
  };
  const Interval& interval_at(double u, double area) const;

  double first_x_ = 0.0, last_x_ = 0.0, integral_ = 0.0, mean_ = 0.0;
  std::vector<Interval> intervals_;   ///< none: the curve is a constant, and x is always first_x_
  std::vector<std::uint32_t> guide_;  ///< for equal steps of u: the interval at the start of the step
};

}  // namespace scintray::core
