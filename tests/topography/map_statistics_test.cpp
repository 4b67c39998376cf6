#include "scintray/topography/map_statistics.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "scintray/core/error.hpp"
#include "scintray/topography/detail/relief.hpp"
#include "topography/made_maps.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::topography;

TEST_CASE("a sinusoid has its closed forms: Sq, Sa, Ssk, Sku, Sdr, slopes") {
  // 8 periods of 80 points: neighbours see the slope to (pi / 80)^2 / 6 = 2.6e-4 of itself.
  constexpr double kAmplitude = 1.5, kPitch = 0.1, kWave = 80 * kPitch;
  const MapStatistics s = map_statistics(test::sinusoid(640, kPitch, kAmplitude, 8, 0));
  CHECK(s.sq_um == doctest::Approx(kAmplitude / std::sqrt(2.0)).epsilon(1e-12));
  CHECK(s.sa_um == doctest::Approx(2.0 * kAmplitude / kPi).epsilon(1e-3));
  CHECK(s.sz_um == doctest::Approx(2.0 * kAmplitude).epsilon(1e-12));
  CHECK(std::abs(s.ssk) < 1e-9);
  CHECK(s.sku == doctest::Approx(1.5).epsilon(1e-12));
  const double steepest = kTwoPi * kAmplitude / kWave;
  CHECK(s.sdq == doctest::Approx(steepest / std::sqrt(2.0)).epsilon(1e-3));
  CHECK(s.rms_slope_x == doctest::Approx(steepest / std::sqrt(2.0)).epsilon(1e-3));
  CHECK(s.rms_slope_y == 0.0);
  // Mean of sqrt(1 + a^2 cos^2): (2 / pi) sqrt(1 + a^2) E(a^2 / (1 + a^2)), E complete, second kind.
  const double root = std::sqrt(1.0 + steepest * steepest);
  CHECK(s.sdr == doctest::Approx(2.0 / kPi * root * std::comp_ellint_2(steepest / root) - 1.0).epsilon(2e-3));
  // Two pitches see a sine's slope lower by cos(pi / 80).
  CHECK(s.slope_ratio_at_two_pitches == doctest::Approx(std::cos(kPi / 80)).epsilon(1e-9));
  CHECK(std::accumulate(s.slope_histogram.begin(), s.slope_histogram.end(), 0.0) == doctest::Approx(1.0));
  const auto highest = static_cast<std::size_t>(std::atan(steepest) / kDegree);
  CHECK(s.slope_histogram[highest] > 0.0);
  CHECK(std::all_of(s.slope_histogram.begin() + static_cast<long>(highest) + 1, s.slope_histogram.end(),
                    [](double share) { return share == 0.0; }));
}

TEST_CASE("a plane's slope is its angle, all over") {
  const MapStatistics s =
      map_statistics(test::map_of(20, 10, 0.25, [](double x, double y) { return 0.3 * x + 0.4 * y; }));
  const double angle = std::atan(0.5);
  CHECK(s.mean_slope_rad == doctest::Approx(angle));
  CHECK(s.rms_slope_rad == doctest::Approx(angle));
  CHECK(s.sdq == doctest::Approx(0.5));
  CHECK(s.sdr == doctest::Approx(std::sqrt(1.25) - 1.0));
  CHECK(s.slope_ratio_at_two_pitches == doctest::Approx(1.0));
  CHECK(s.slope_histogram[static_cast<std::size_t>(angle / kDegree)] == doctest::Approx(1.0));
}

TEST_CASE("a Gaussian surface has Ssk 0 and Sku 3, and loses slope over two pitches by its correlation") {
  constexpr double kLength = 1.0, kPitch = 0.175;
  SynthesisRecipe recipe;
  recipe.gaussian.rms_height_um = 0.4;
  recipe.gaussian.correlation_length_um = kLength;
  const MapStatistics s = map_statistics(synthesize(recipe));
  CHECK(s.sq_um == doctest::Approx(0.4).epsilon(1e-9));
  // For the autocorrelation r = exp(-d^2 / T^2) over the area A: var Ssk = 6 int r^3 / A = 2 pi T^2 / A,
  // var Sku = 24 int r^4 / A = 6 pi T^2 / A. Four standard deviations: one false alarm in 16,000 seeds.
  const double area = std::pow(514 * kPitch, 2);
  CHECK(std::abs(s.ssk) < 4.0 * std::sqrt(kTwoPi * kLength * kLength / area));
  CHECK(std::abs(s.sku - 3.0) < 4.0 * std::sqrt(3.0 * kTwoPi * kLength * kLength / area));
  // Differences over k pitches have the variance 2 Sq^2 (1 - exp(-k^2 u)), u = (pitch / T)^2.
  const double u = kPitch * kPitch / (kLength * kLength);
  CHECK(s.slope_ratio_at_two_pitches ==
        doctest::Approx(std::sqrt(0.25 * -std::expm1(-4.0 * u) / -std::expm1(-u))).epsilon(0.005));
}

TEST_CASE("white noise loses half its slope over two pitches") {
  Rng rng(5, StreamKind::other, 0);
  const MapStatistics s =
      map_statistics(test::map_of(300, 300, 1.0, [&](double, double) { return rng.uniform(); }));
  CHECK(s.slope_ratio_at_two_pitches == doctest::Approx(0.5).epsilon(0.02));
}

TEST_CASE("missing points take no part") {
  const auto wave = [](double x, double y) { return std::sin(x) + 0.3 * std::cos(2.0 * y); };
  HeightMap map = test::map_of(200, 150, 0.05, wave);
  HeightMap part = test::map_of(120, 150, 0.05, wave);
  for (std::uint32_t j = 0; j < map.rows; ++j)
    for (std::uint32_t i = 120; i < map.columns; ++i) map.at(i, j) = std::numeric_limits<double>::quiet_NaN();
  const MapStatistics holed = map_statistics(map), whole = map_statistics(part);
  CHECK(holed.points == 120 * 150);
  CHECK(holed.missing == 80 * 150);
  CHECK(whole.missing == 0);
  for (const auto member :
       {&MapStatistics::sa_um, &MapStatistics::sq_um, &MapStatistics::sz_um, &MapStatistics::ssk,
        &MapStatistics::sku, &MapStatistics::sdq, &MapStatistics::sdr, &MapStatistics::mean_slope_rad,
        &MapStatistics::slope_ratio_at_two_pitches})
    CHECK(holed.*member == doctest::Approx(whole.*member).epsilon(1e-12));
  std::fill(map.heights_um.begin(), map.heights_um.end(), std::nan(""));
  CHECK_THROWS_AS(map_statistics(map), InputError);
}
