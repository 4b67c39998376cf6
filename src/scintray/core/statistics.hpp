#pragma once
/// Uncertainties and tests of agreement.

#include <cstdint>
#include <span>

namespace scintray::core {

/// Full width at half maximum of a Gaussian over its standard deviation, 2 sqrt(2 ln 2).
inline constexpr double kFwhmPerSigma = 2.3548200450309493;

/// A value with its one-sigma standard error.
struct Estimate {
  double value = 0.0;
  double error = 0.0;
};

/// Fraction k/n with the binomial standard error sqrt(p(1-p)/n); when k is 0 or n the error is that
/// of one count in n, so that it is never zero. Without trials (n = 0): 0 with the error 1.
Estimate binomial_estimate(std::uint64_t k, std::uint64_t n);

/// Sums that determine mean and variance; merging is exact up to rounding and is done in a fixed order so
/// that results do not depend on threads.
struct Moments {
  std::uint64_t count = 0;
  double sum = 0.0;
  double sum_of_squares = 0.0;

  void add(double x) {
    ++count;
    sum += x;
    sum_of_squares += x * x;
  }
  void merge(const Moments& other) {
    count += other.count;
    sum += other.sum;
    sum_of_squares += other.sum_of_squares;
  }
  /// Mean and its standard error (sample standard deviation over sqrt(count)); zeros when empty.
  Estimate mean() const;
  /// Sample standard deviation.
  double standard_deviation() const;
};

/// Standard error of an estimate from its G values without one of G groups of the sample each, independent
/// and alike: s^2 = (G - 1) / G sum (value - mean of the values)^2. For the mean of groups of one size this
/// is the variance of a mean; for what is nearly linear in the sums over groups it holds to first order.
/// @param without  at least two values
double jackknife_error(std::span<const double> without);

/// |a - b| in units of the combined standard error.
double sigmas(const Estimate& a, const Estimate& b);

/// Probability that a chi-square with `degrees` degrees of freedom exceeds `chi2`: the regularised
/// upper incomplete gamma function Q(degrees/2, chi2/2), by Boost.
double chi_square_p_value(double chi2, double degrees);

struct ChiSquare {
  double chi2 = 0.0;
  double degrees = 0.0;
  double p_value = 1.0;
};

/// Chi-square of observed counts against expected counts; neighbouring bins are merged until each
/// expects at least 10. A count where nothing is expected gives p = 0. Sizes must agree
/// (std::invalid_argument).
ChiSquare chi_square_test(std::span<const std::uint64_t> observed, std::span<const double> expected);

/// Chi-square test that two histograms are samples of one distribution, whatever their totals
/// (Numerical Recipes 3rd ed., eq. 14.3.3); bins are merged until both together hold at least 20.
/// An empty histogram has no shape: p = 1, so compare totals as well.
ChiSquare chi_square_two_samples(std::span<const std::uint64_t> a, std::span<const std::uint64_t> b);

}  // namespace scintray::core
