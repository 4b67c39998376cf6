#include "scintray/core/statistics.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace scintray {

namespace {

/// Regularised upper incomplete gamma function Q(a, x), by series or continued fraction
/// (Numerical Recipes 3rd ed., section 6.2).
double upper_gamma(double a, double x) {
  if (x <= 0.0) return 1.0;
  const double scale = std::exp(-x + a * std::log(x) - std::lgamma(a));
  if (x < a + 1.0) {
    double term = 1.0 / a, sum = term;
    for (double n = a + 1.0; std::abs(term) > std::abs(sum) * 1e-15; n += 1.0) {
      term *= x / n;
      sum += term;
    }
    return 1.0 - sum * scale;
  }
  constexpr double kTiny = std::numeric_limits<double>::min() / std::numeric_limits<double>::epsilon();
  double b = x + 1.0 - a, c = 1.0 / kTiny, d = 1.0 / b, h = d;
  for (int i = 1; i < 10000; ++i) {
    const double an = -i * (i - a);
    b += 2.0;
    d = an * d + b;
    if (std::abs(d) < kTiny) d = kTiny;
    c = b + an / c;
    if (std::abs(c) < kTiny) c = kTiny;
    d = 1.0 / d;
    const double factor = d * c;
    h *= factor;
    if (std::abs(factor - 1.0) < 1e-15) break;
  }
  return scale * h;
}

}  // namespace

Estimate binomial_estimate(std::uint64_t k, std::uint64_t n) {
  if (n == 0) return {0.0, 1.0};
  const double total = static_cast<double>(n);
  const double p = static_cast<double>(k) / total;
  if (k == 0 || k == n) return {p, 1.0 / total};
  return {p, std::sqrt(p * (1.0 - p) / total)};
}

Estimate Moments::mean() const {
  if (count == 0) return {};
  return {sum / static_cast<double>(count), standard_deviation() / std::sqrt(static_cast<double>(count))};
}

double Moments::standard_deviation() const {
  if (count < 2) return 0.0;
  const double n = static_cast<double>(count);
  return std::sqrt(std::max(0.0, (sum_of_squares - sum * sum / n) / (n - 1.0)));
}

double sigmas(const Estimate& a, const Estimate& b) {
  const double combined = std::sqrt(a.error * a.error + b.error * b.error);
  if (combined == 0.0) return a.value == b.value ? 0.0 : std::numeric_limits<double>::infinity();
  return std::abs(a.value - b.value) / combined;
}

double chi_square_p_value(double chi2, double degrees) {
  return degrees > 0.0 ? upper_gamma(0.5 * degrees, 0.5 * chi2) : 1.0;
}

ChiSquare chi_square_test(std::span<const std::uint64_t> observed, std::span<const double> expected) {
  if (observed.size() != expected.size()) throw std::invalid_argument("chi_square_test: sizes differ");
  constexpr double kLeastExpected = 10.0;
  ChiSquare result;
  double o = 0.0, e = 0.0, rest_o = 0.0, rest_e = 0.0;
  for (std::size_t i = 0; i < observed.size(); ++i) {
    o += static_cast<double>(observed[i]);
    e += expected[i];
    if (e < kLeastExpected) continue;
    result.chi2 += (o - e) * (o - e) / e;
    result.degrees += 1.0;
    o = e = 0.0;
  }
  rest_o = o;
  rest_e = e;
  if (rest_e > 0.0) {
    result.chi2 += (rest_o - rest_e) * (rest_o - rest_e) / rest_e;
    result.degrees += 1.0;
  } else if (rest_o > 0.0) {
    result.chi2 = std::numeric_limits<double>::infinity();  // counts where none can be
  }
  result.degrees -= 1.0;
  result.p_value = chi_square_p_value(result.chi2, result.degrees);
  return result;
}

ChiSquare chi_square_two_samples(std::span<const std::uint64_t> a, std::span<const std::uint64_t> b) {
  if (a.size() != b.size()) throw std::invalid_argument("chi_square_two_samples: sizes differ");
  constexpr double kLeastTogether = 20.0;
  double total_a = 0.0, total_b = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    total_a += static_cast<double>(a[i]);
    total_b += static_cast<double>(b[i]);
  }
  ChiSquare result;
  if (total_a == 0.0 || total_b == 0.0) return result;
  const double weight_a = std::sqrt(total_b / total_a), weight_b = std::sqrt(total_a / total_b);
  double sum_a = 0.0, sum_b = 0.0;
  const auto add_bin = [&] {
    if (sum_a + sum_b == 0.0) return;
    const double difference = weight_a * sum_a - weight_b * sum_b;
    result.chi2 += difference * difference / (sum_a + sum_b);
    result.degrees += 1.0;
    sum_a = sum_b = 0.0;
  };
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum_a += static_cast<double>(a[i]);
    sum_b += static_cast<double>(b[i]);
    if (sum_a + sum_b >= kLeastTogether) add_bin();
  }
  add_bin();
  result.degrees -= 1.0;
  result.p_value = chi_square_p_value(result.chi2, result.degrees);
  return result;
}

}  // namespace scintray
