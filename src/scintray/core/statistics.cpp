#include "scintray/core/statistics.hpp"

#include <algorithm>
#include <boost/math/policies/policy.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace scintray::core {

namespace {

/// Numbers out of range give NaN or infinity, and no exception.
using Quiet = boost::math::policies::policy<
    boost::math::policies::domain_error<boost::math::policies::ignore_error>,
    boost::math::policies::pole_error<boost::math::policies::ignore_error>,
    boost::math::policies::overflow_error<boost::math::policies::ignore_error>,
    boost::math::policies::evaluation_error<boost::math::policies::ignore_error>>;

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

double jackknife_error(std::span<const double> without) {
  const auto groups = static_cast<double>(without.size());
  double sum = 0.0, squares = 0.0;
  for (const double value : without) sum += value;
  for (const double value : without) squares += (value - sum / groups) * (value - sum / groups);
  return std::sqrt((groups - 1.0) / groups * squares);
}

double sigmas(const Estimate& a, const Estimate& b) {
  const double combined = std::sqrt(a.error * a.error + b.error * b.error);
  if (combined == 0.0) return a.value == b.value ? 0.0 : std::numeric_limits<double>::infinity();
  return std::abs(a.value - b.value) / combined;
}

double chi_square_p_value(double chi2, double degrees) {
  if (!(degrees > 0.0) || chi2 <= 0.0) return 1.0;
  return boost::math::gamma_q(0.5 * degrees, 0.5 * chi2, Quiet());
}

ChiSquare chi_square_test(std::span<const std::uint64_t> observed, std::span<const double> expected) {
  if (observed.size() != expected.size()) throw std::invalid_argument("chi_square_test: sizes differ");
  constexpr double kLeastExpected = 10.0;
  struct Bin {
    double observed = 0.0, expected = 0.0;
  };
  std::vector<Bin> bins;
  Bin bin;
  bool impossible = false;  // counts where none are expected
  for (std::size_t i = 0; i < observed.size(); ++i) {
    impossible = impossible || (observed[i] > 0 && !(expected[i] > 0.0));
    bin.observed += static_cast<double>(observed[i]);
    bin.expected += expected[i];
    if (bin.expected < kLeastExpected) continue;
    bins.push_back(bin);
    bin = {};
  }
  if (bins.empty()) bins.emplace_back();
  bins.back().observed += bin.observed;
  bins.back().expected += bin.expected;

  ChiSquare result;
  if (impossible) return {std::numeric_limits<double>::infinity(), static_cast<double>(bins.size() - 1), 0.0};
  for (const Bin& merged : bins) {
    if (merged.expected > 0.0)
      result.chi2 +=
          (merged.observed - merged.expected) * (merged.observed - merged.expected) / merged.expected;
    result.degrees += 1.0;
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
  if (total_a == 0.0 || total_b == 0.0) return {};
  struct Bin {
    double a = 0.0, b = 0.0;
  };
  std::vector<Bin> bins;
  Bin bin;
  for (std::size_t i = 0; i < a.size(); ++i) {
    bin.a += static_cast<double>(a[i]);
    bin.b += static_cast<double>(b[i]);
    if (bin.a + bin.b < kLeastTogether) continue;
    bins.push_back(bin);
    bin = {};
  }
  if (bins.empty()) bins.emplace_back();
  bins.back().a += bin.a;
  bins.back().b += bin.b;

  ChiSquare result;
  const double weight_a = std::sqrt(total_b / total_a), weight_b = std::sqrt(total_a / total_b);
  for (const Bin& merged : bins) {
    const double difference = weight_a * merged.a - weight_b * merged.b;
    result.chi2 += difference * difference / (merged.a + merged.b);
    result.degrees += 1.0;
  }
  result.degrees -= 1.0;
  result.p_value = chi_square_p_value(result.chi2, result.degrees);
  return result;
}

}  // namespace scintray::core
