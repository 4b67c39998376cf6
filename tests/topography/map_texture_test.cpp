#include "scintray/topography/map_texture.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "scintray/core/error.hpp"
#include "scintray/topography/detail/relief.hpp"
#include "topography/made_maps.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::topography;

namespace {

/// Autocorrelation exp(-(u / along)^2 - (v / across)^2), exactly.
HeightMap gaussian(double across_um, double along_um, double angle_rad, std::uint64_t seed) {
  const GaussianRelief relief{0.5, across_um, along_um, angle_rad};
  return test::random_phases(400, 0.2, seed,
                             [&](double fx, double fy) { return gaussian_density(relief, fx, fy); });
}

/// Where that autocorrelation, less its mean over the field of 80 um (pi across along / area), has
/// fallen to `level` on an axis of correlation length `length_um`.
double lag_at(double level, double across_um, double along_um, double length_um) {
  const double mean = kPi * across_um * along_um / 6400.0;
  return length_um * std::sqrt(-std::log(level * (1.0 - mean) + mean));
}

bool warns(const HeightMap& map, const std::string& part) {
  for (const std::string& warning : map_warnings(map, map_statistics(map), map_texture(map)))
    if (warning.find(part) != std::string::npos) return true;
  return false;
}

double turned(double a, double b) { return std::abs(std::remainder(a - b, kPi)); }

}  // namespace

TEST_CASE("a sinusoid: Sal is acos(0.2) / 2 pi of its wavelength, Std lies along its crests") {
  for (const auto& row : {std::pair{5, 0}, {0, 5}, {3, 4}, {4, -3}}) {
    const auto& m = row.first;
    const auto& n = row.second;
    const HeightMap map = test::sinusoid(300, 0.1, 0.7, m, n);
    const MapTexture texture = map_texture(map);
    const double wavelength = 30.0 / std::hypot(m, n);
    CAPTURE(m);
    CAPTURE(n);
    REQUIRE(texture.sal_um);
    // Linear between pitches of 1/60 of the wavelength: the cosine errs by (2 pi / 60)^2 / 8 at most.
    CHECK(*texture.sal_um == doctest::Approx(wavelength * std::acos(0.2) / kTwoPi).epsilon(0.002));
    REQUIRE(texture.std_rad);
    CHECK(turned(*texture.std_rad, std::atan2(n, m) + 0.5 * kPi) < 1e-6);
    REQUIRE(texture.str);
    CHECK(texture.str_is_bound);
    CHECK(*texture.str < 0.1);
  }
}

TEST_CASE("a Gaussian surface: Sal is T sqrt(ln 5), the 1/e length T, Str the ratio, Std the lay") {
  // Between pitches of T / 10 the linear autocorrelation errs by 0.0025 at most, Sal by 0.5 %.
  const MapTexture isotropic = map_texture(gaussian(2.0, 2.0, 0.0, 1));
  CHECK(*isotropic.sal_um == doctest::Approx(lag_at(0.2, 2.0, 2.0, 2.0)).epsilon(0.005));
  CHECK(lag_at(0.2, 2.0, 2.0, 2.0) == doctest::Approx(2.0 * std::sqrt(std::log(5.0))).epsilon(0.005));
  CHECK(*isotropic.correlation_length_um ==
        doctest::Approx(lag_at(std::exp(-1.0), 2.0, 2.0, 2.0)).epsilon(0.005));
  CHECK(*isotropic.str == doctest::Approx(1.0).epsilon(0.005));
  CHECK_FALSE(isotropic.str_is_bound);
  for (const double degrees : {0.0, 30.0, 90.0, 117.0}) {
    const MapTexture grooved = map_texture(gaussian(2.0, 8.0, degrees * kDegree, 2));
    CAPTURE(degrees);
    CHECK(*grooved.sal_um == doctest::Approx(lag_at(0.2, 2.0, 8.0, 2.0)).epsilon(0.005));
    CHECK(*grooved.str == doctest::Approx(0.25).epsilon(0.01));
    // The spectrum is symmetric about the direction across the lay; its grid of terms is not quite.
    CHECK(turned(*grooved.std_rad, degrees * kDegree) < 1.0 * kDegree);
  }
}

TEST_CASE("texture is found in part of a surface too, with points missing") {
  HeightMap map = gaussian(1.0, 4.0, 40 * kDegree, 3);
  map.periodic = false;
  Rng rng(4, StreamKind::other, 0);
  for (double& height : map.heights_um)
    if (rng.uniform() < 0.2) height = std::numeric_limits<double>::quiet_NaN();
  const MapTexture texture = map_texture(map);
  // The 80 um field without its period: the autocorrelation at a lag is a mean over fewer pairs, and
  // noisy. 10 % is many times the change seen.
  CHECK(*texture.sal_um == doctest::Approx(std::sqrt(std::log(5.0))).epsilon(0.1));
  CHECK(*texture.str == doctest::Approx(0.25).epsilon(0.2));
  CHECK(turned(*texture.std_rad, 40 * kDegree) < 3.0 * kDegree);
}

TEST_CASE("the autocorrelation of a map without a period is over its pairs, not padded with zeros") {
  const HeightMap map =
      test::map_of(64, 8, 0.5, [](double x, double) { return std::fmod(x, 1.0) > 0.2 ? 1.0 : -1.0; });
  const Autocorrelation correlation(map);  // +1 -1 +1 -1 along x
  CHECK(correlation.at(0.0, 0.0) == doctest::Approx(1.0));
  CHECK(correlation.at(0.5, 0.0) == doctest::Approx(-1.0));
  CHECK(correlation.at(15.0, 0.0) == doctest::Approx(1.0));
  CHECK(correlation.at(0.25, 0.0) == doctest::Approx(0.0));
  CHECK(correlation.at(0.0, 2.0) == doctest::Approx(1.0));
}

TEST_CASE("maps too coarse, too small or with missing points are warned of, sound ones are not") {
  CHECK(map_warnings(gaussian(2.0, 2.0, 0.0, 1), map_statistics(gaussian(2.0, 2.0, 0.0, 1)),
                     map_texture(gaussian(2.0, 2.0, 0.0, 1)))
            .empty());
  CHECK(warns(gaussian(0.4, 0.4, 0.0, 1), "too coarse"));
  CHECK(warns(gaussian(8.0, 8.0, 0.0, 1), "too small"));
  CHECK_FALSE(warns(gaussian(8.0, 8.0, 0.0, 1), "too coarse"));
  CHECK(warns(test::map_of(50, 50, 1.0, [](double x, double) { return x; }), "too small"));
  HeightMap holed = gaussian(2.0, 2.0, 0.0, 1);
  holed.at(3, 3) = std::nan("");
  CHECK(warns(holed, "1 points"));
}

TEST_CASE("a flat map has no texture, and one without heights is refused") {
  const MapTexture flat = map_texture(test::map_of(10, 10, 1.0, [](double, double) { return 2.0; }));
  CHECK_FALSE(flat.sal_um);
  CHECK_FALSE(flat.str);
  CHECK_FALSE(flat.std_rad);
  CHECK_THROWS_AS(map_texture(test::map_of(4, 4, 1.0, [](double, double) { return std::nan(""); })),
                  InputError);
}
