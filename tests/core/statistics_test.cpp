#include "scintray/core/statistics.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

using namespace scintray;
using namespace scintray::core;
using doctest::Approx;

TEST_CASE("The chi-square p-value agrees with its closed forms") {
  // Abramowitz and Stegun 1964, eqs. 26.4.4 and 26.4.5: erfc for 1 degree, finite sums for even numbers.
  for (const double chi2 : {0.001, 0.5, 1.0, 3.0, 7.0, 25.0, 120.0}) {
    CAPTURE(chi2);
    const double half = 0.5 * chi2;
    CHECK(chi_square_p_value(chi2, 1) == Approx(std::erfc(std::sqrt(half))).epsilon(1e-11));
    CHECK(chi_square_p_value(chi2, 2) == Approx(std::exp(-half)).epsilon(1e-11));
    CHECK(chi_square_p_value(chi2, 4) == Approx(std::exp(-half) * (1.0 + half)).epsilon(1e-11));
    double term = 1.0, sum = 1.0;
    for (int k = 1; k < 50; ++k) sum += term *= half / k;
    CHECK(chi_square_p_value(chi2, 100) == Approx(std::exp(-half) * sum).epsilon(1e-10));
  }
}

TEST_CASE("The chi-square p-value at its ends") {
  CHECK(chi_square_p_value(0.0, 5) == 1.0);
  CHECK(chi_square_p_value(std::numeric_limits<double>::infinity(), 5) == 0.0);
  CHECK(chi_square_p_value(3.0, 0) == 1.0);
}

TEST_CASE("A chi-square test by hand") {
  const std::array<std::uint64_t, 3> observed{44, 56, 100};
  const std::array<double, 3> expected{50, 50, 100};
  const ChiSquare result = chi_square_test(observed, expected);
  CHECK(result.chi2 == Approx(36.0 / 50.0 * 2.0));
  CHECK(result.degrees == 2.0);
  CHECK(result.p_value == Approx(std::exp(-0.72)));
}

TEST_CASE("Bins that expect few are merged with their neighbours, the last ones too") {
  const std::array<std::uint64_t, 5> observed{3, 9, 20, 1, 2};
  const std::array<double, 5> expected{5, 6, 20, 2, 3};
  const ChiSquare result = chi_square_test(observed, expected);  // {12, 23} against {11, 25}
  CHECK(result.degrees == 1.0);
  CHECK(result.chi2 == Approx(1.0 / 11.0 + 4.0 / 25.0));
}

TEST_CASE("A count where nothing is expected refutes the distribution") {
  const std::array<double, 3> expected{100, 0, 100};
  CHECK(chi_square_test(std::array<std::uint64_t, 3>{100, 1, 99}, expected).p_value == 0.0);
  CHECK(chi_square_test(std::array<std::uint64_t, 3>{100, 0, 100}, expected).p_value == 1.0);
  CHECK_THROWS_AS(chi_square_test(std::array<std::uint64_t, 2>{1, 1}, expected), std::invalid_argument);
}

TEST_CASE("Two samples of one shape agree whatever their sizes, of two shapes they do not") {
  const std::array<std::uint64_t, 3> small{100, 200, 300}, large{1000, 2000, 3000}, turned{3000, 2000, 1000};
  const ChiSquare same = chi_square_two_samples(small, large);
  CHECK(same.chi2 == Approx(0.0));
  CHECK(same.degrees == 2.0);
  CHECK(chi_square_two_samples(small, turned).p_value < 1e-20);
  // By hand: sum of (sqrt(B/A) a - sqrt(A/B) b)^2 / (a + b) with A = B = 100.
  const ChiSquare hand =
      chi_square_two_samples(std::array<std::uint64_t, 2>{40, 60}, std::array<std::uint64_t, 2>{55, 45});
  CHECK(hand.chi2 == Approx(225.0 / 95.0 + 225.0 / 105.0));
  CHECK(hand.degrees == 1.0);
}

TEST_CASE("Binomial fractions have an error that is never zero") {
  CHECK(binomial_estimate(20, 100).value == Approx(0.2));
  CHECK(binomial_estimate(20, 100).error == Approx(0.04));
  CHECK(binomial_estimate(0, 100).error == Approx(0.01));
  CHECK(binomial_estimate(100, 100).error == Approx(0.01));
  CHECK(binomial_estimate(0, 0).error == 1.0);
}

TEST_CASE("Moments have mean and standard error, also when merged") {
  Moments a, b;
  for (const double x : {1.0, 2.0, 3.0}) a.add(x);
  for (const double x : {4.0, 5.0}) b.add(x);
  a.merge(b);
  CHECK(a.mean().value == Approx(3.0));
  CHECK(a.standard_deviation() == Approx(std::sqrt(2.5)));
  CHECK(a.mean().error == Approx(std::sqrt(0.5)));
  CHECK(Moments{}.mean().value == 0.0);
}

TEST_CASE("Agreement in standard errors") {
  CHECK(sigmas({10.0, 3.0}, {20.0, 4.0}) == Approx(2.0));
  CHECK(sigmas({1.0, 0.0}, {1.0, 0.0}) == 0.0);
  CHECK(std::isinf(sigmas({1.0, 0.0}, {2.0, 0.0})));
}
