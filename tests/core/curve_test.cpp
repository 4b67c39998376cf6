#include "scintray/core/curve.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/core/rng.hpp"
#include "scintray/core/statistics.hpp"

using namespace scintray;
using namespace scintray::core;
using doctest::Approx;

TEST_CASE("A curve interpolates linearly and keeps its end values outside") {
  const Curve curve({400, 500, 700}, {1.0, 2.0, 0.0});
  CHECK(curve(400) == 1.0);
  CHECK(curve(450) == Approx(1.5));
  CHECK(curve(600) == Approx(1.0));
  CHECK(curve(700) == 0.0);
  CHECK(curve(300) == 1.0);
  CHECK(curve(900) == 0.0);
  CHECK(curve.min_y() == 0.0);
  CHECK(curve.max_y() == 2.0);
}

TEST_CASE("A curve of any number of points interpolates between the two about each abscissa") {
  Rng rng(1, StreamKind::other, 0);
  for (std::size_t number = 4; number <= 67; ++number) {
    const std::size_t points = number / 2;
    const double decades = number % 2 == 0 ? 0.0 : 6.0;  // of the distances between points
    std::vector<double> x{0.0}, y{rng.uniform()};
    while (x.size() < points) {
      x.push_back(x.back() + (0.1 + rng.uniform()) * std::pow(10.0, decades * rng.uniform()));
      y.push_back(rng.uniform());
    }
    const Curve curve(x, y);
    for (std::size_t i = 1; i < points; ++i)
      for (const double at : {x[i - 1], std::nextafter(x[i - 1], x[i]), 0.3 * x[i - 1] + 0.7 * x[i],
                              std::nextafter(x[i], x[i - 1])}) {
        CAPTURE(points);
        CAPTURE(decades);
        CAPTURE(i);
        const double share = (at - x[i - 1]) / (x[i] - x[i - 1]);
        CHECK(curve(at) == (at == x.front() ? y.front() : y[i - 1] + share * (y[i] - y[i - 1])));
      }
  }
}

TEST_CASE("A curve knows its range; a constant covers everything") {
  const Curve curve({400, 700}, {1.0, 2.0});
  CHECK(curve.covers(400, 700));
  CHECK_FALSE(curve.covers(399, 700));
  CHECK_FALSE(curve.covers(400, 701));
  CHECK(Curve::constant(1.5).covers(-1e9, 1e9));
  CHECK(Curve::constant(1.5)(123.0) == 1.5);
  CHECK(Curve::constant(1.5).derivative(123.0) == 0.0);
}

TEST_CASE("The slope of a straight line is exact, that of a parabola at its inner points") {
  const Curve line({0, 1, 3, 4}, {1, 3, 7, 9});
  for (const double x : {-1.0, 0.0, 0.3, 1.0, 2.0, 3.5, 4.0, 9.0}) CHECK(line.derivative(x) == Approx(2.0));
  const Curve parabola({0, 1, 2, 3}, {0, 1, 4, 9});
  CHECK(parabola.derivative(1.0) == Approx(2.0));
  CHECK(parabola.derivative(1.5) == Approx(3.0));
}

TEST_CASE("Malformed tables are refused") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(Curve({}, {}), InputError);
  CHECK_THROWS_AS(Curve({1, 2}, {1}), InputError);
  CHECK_THROWS_AS(Curve({1, 1}, {1, 2}), InputError);
  CHECK_THROWS_AS(Curve({2, 1}, {1, 2}), InputError);
  CHECK_THROWS_AS(Curve({1, nan}, {1, 2}), InputError);
  CHECK_THROWS_AS(Curve({1, 2}, {1, nan}), InputError);
}

TEST_CASE("The share of a spectrum below x is the inverse of drawing from it") {
  const CurveSampler sampler(Curve({400, 450, 470, 500}, {0, 2, 0, 1}));
  for (const double u : {0.0, 0.1, 0.5, 0.77, 0.999})
    CHECK(sampler.share_below(sampler.sample(u)) == Approx(u));
  CHECK(sampler.share_below(300.0) == 0.0);
  CHECK(sampler.share_below(500.0) == 1.0);
  CHECK(sampler.share_below(600.0) == 1.0);
  // Areas by hand: triangles of 50 x 2, 20 x 2 and 30 x 1, halved.
  CHECK(sampler.share_below(470.0) == Approx(70.0 / 85.0));
  CHECK(CurveSampler(Curve::constant(1.0)).share_below(1.0) == 1.0);
}

TEST_CASE("A spectrum must be a density") {
  CHECK_THROWS_AS(CurveSampler(Curve({1, 2}, {1, -1})), InputError);
  CHECK_THROWS_AS(CurveSampler(Curve({1, 2}, {0, 0})), InputError);
}

TEST_CASE("The sampler inverts the integral of the curve") {
  // Triangle with peak 1 at x = 1 over [0, 3]: the integral up to x is x^2/3 before the peak.
  const CurveSampler sampler(Curve({0, 1, 3}, {0, 1, 0}));
  CHECK(sampler.sample(0.0) == 0.0);
  for (const double x : {0.1, 0.5, 0.9}) CHECK(sampler.sample(x * x / 3.0) == Approx(x));
  for (const double x : {1.5, 2.9}) CHECK(sampler.sample(1.0 - (3 - x) * (3 - x) / 6.0) == Approx(x));
  CHECK(sampler.sample(std::nextafter(1.0, 0.0)) <= 3.0);
  CHECK(sampler.mean() == Approx(4.0 / 3.0));  // mean of a triangle's corners 0, 1, 3
  CHECK(CurveSampler(Curve::constant(420.0)).sample(0.7) == 0.0);
}

TEST_CASE("Nothing is sampled where the spectrum is zero") {
  const CurveSampler sampler(Curve({0, 1, 2, 3}, {1, 0, 0, 1}));
  for (int i = 0; i < 1000; ++i) {
    const double x = sampler.sample(i / 1000.0);
    CHECK((x <= 1.0 || x >= 2.0));
  }
}

TEST_CASE("The interval of a draw is the one that a search finds") {
  // Irregular, with intervals of no light, and one that holds half of it; by a plain search the same bits.
  Rng rng(11, StreamKind::other, 0);
  std::vector<double> x{300.0}, y{0.0};
  for (int i = 0; i < 200; ++i) {
    x.push_back(x.back() + (i % 7 == 0 ? 5.0 : 0.01) * (0.1 + rng.uniform()));
    y.push_back(i % 5 < 2 ? 0.0 : (i == 103 ? 1000.0 : rng.uniform()));
  }
  std::vector<double> below{0.0};
  for (std::size_t i = 1; i < x.size(); ++i)
    below.push_back(below.back() + 0.5 * (y[i] + y[i - 1]) * (x[i] - x[i - 1]));
  const auto by_search = [&](double u) {
    const double area = u * below.back();
    auto i = static_cast<std::size_t>(std::upper_bound(below.begin(), below.end(), area) - below.begin());
    i = std::clamp<std::size_t>(i, 1, x.size() - 1);
    const double rest = (area - below[i - 1]) / (x[i] - x[i - 1]), step = y[i] - y[i - 1];
    const double root = std::sqrt(std::max(0.0, y[i - 1] * y[i - 1] + 2.0 * step * rest));
    const double t = y[i - 1] + root > 0.0 ? 2.0 * rest / (y[i - 1] + root) : 0.0;
    return x[i - 1] + std::clamp(t, 0.0, 1.0) * (x[i] - x[i - 1]);
  };
  const CurveSampler sampler(Curve(x, y));
  std::vector<double> draws;
  for (int i = 0; i < 20000; ++i) draws.push_back(rng.uniform());
  for (const double area : below)
    for (const double u : {area / below.back(), std::nextafter(area / below.back(), 0.0),
                           std::nextafter(area / below.back(), 1.0)})
      if (u < 1.0) draws.push_back(u);
  for (int step = 0; step < 800; ++step)
    for (const double u : {step / 800.0, std::nextafter(step / 800.0, 0.0)}) draws.push_back(u);
  std::size_t same = 0;
  for (const double u : draws) same += sampler.sample(u) == by_search(u) ? 1 : 0;
  CHECK(same == draws.size());
}

TEST_CASE("Sampled wavelengths follow the spectrum") {
  // False-alarm rate of the bound: 6.3e-5, as 4 standard errors.
  const Curve spectrum({380, 420, 440, 600}, {0.0, 1.0, 0.4, 0.1});
  const CurveSampler sampler(spectrum);
  const double area = 0.5 * (40 * 1.0 + 20 * 1.4 + 160 * 0.5);
  constexpr int kBins = 22;  // of 10 nm, so that the corners are bin edges
  constexpr int kSamples = 200000;
  std::vector<std::uint64_t> observed(kBins);
  std::vector<double> expected(kBins);
  for (int i = 0; i < kBins; ++i) expected[i] = kSamples * 10.0 * spectrum(385.0 + 10 * i) / area;
  Rng rng(7, StreamKind::other, 0);
  for (int i = 0; i < kSamples; ++i)
    ++observed.at(static_cast<std::size_t>((sampler.sample(rng.uniform()) - 380) / 10));
  CHECK(chi_square_test(observed, expected).p_value > 6.3e-5);
}
