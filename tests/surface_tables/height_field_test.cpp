#include "scintray/optics/height_field.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "scintray/core/error.hpp"
#include "scintray/core/sampling.hpp"
#include "scintray/core/statistics.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;

// Statistical bounds are 4 standard errors: one false alarm in 16,000 checks; the seeds are fixed.

namespace {

constexpr IndexPair kCrystalInAir{1.82, 1.0};

Ray arriving(Side side, double incidence, double azimuth = 0.0) {
  const double up = side == Side::inside ? 1.0 : -1.0;
  return {{std::sin(incidence) * std::cos(azimuth), std::sin(incidence) * std::sin(azimuth),
           up * std::cos(incidence)},
          Vec3::Zero()};
}

HeightField flat() { return HeightField(std::vector<float>(7 * 5, 0.25f), 7, 5, 0.3, 0.2); }

/// Roofs along y with slopes of `slope` both ways along x.
HeightField roofs(double slope) {
  std::vector<float> heights;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 32; ++i) heights.push_back(static_cast<float>(slope * std::min(i, 32 - i)));
  return HeightField(heights, 32, 4, 1.0, 1.0);
}

}  // namespace

TEST_CASE("a flat height field reflects by Fresnel and keeps directions exact") {
  const HeightField field = flat();
  for (const Side side : {Side::inside, Side::outside})
    for (const double degrees : {0.0, 20.0, 33.0, 34.0, 60.0, 89.9}) {
      const double incidence = degrees * kDegree;
      const double n1 = kCrystalInAir.on(side), n2 = kCrystalInAir.on(other(side));
      const FresnelCoefficients law = fresnel(std::cos(incidence), n1, n2);
      std::uint64_t reflected = 0;
      constexpr std::uint64_t kRays = 20000;
      double worst = 0.0;
      bool once = true;
      for (std::uint64_t k = 0; k < kRays; ++k) {
        Rng rng(11, StreamKind::other, static_cast<std::uint64_t>(degrees), k);
        const double azimuth = kTwoPi * rng.uniform();
        Ray ray = arriving(side, incidence, azimuth);
        const double x = 2.1 * rng.uniform(), y = rng.uniform();
        const HeightFieldExit exit = field.follow(ray, side, x, y, kCrystalInAir, rng);
        once = once && exit.facet_interactions == 1 && exit.first_slope_rad == 0.0 && !exit.cut;
        const double sine = exit.side == side ? std::sin(incidence) : std::sin(incidence) * n1 / n2;
        const Vec3 expected(sine * std::cos(azimuth), sine * std::sin(azimuth),
                            (exit.side == Side::outside ? 1.0 : -1.0) * std::sqrt(1.0 - sine * sine));
        worst = std::max(worst, (ray.direction - expected).norm());
        reflected += exit.side == side ? 1 : 0;
      }
      CAPTURE(degrees);
      CHECK(once);
      CHECK(worst < 1e-7);
      const double p = law.unpolarised();
      CHECK(std::abs(static_cast<double>(reflected) / kRays - p) <= 4.0 * std::sqrt(p * (1.0 - p) / kRays));
    }
}

TEST_CASE("roofs of one slope: projected-area weights, and one Fresnel reflection at the tilted facet") {
  const double tilt = 10.0 * kDegree;
  const HeightField field = roofs(std::tan(tilt));
  constexpr std::uint64_t kRays = 40000;

  SUBCASE("normal incidence: every ray leaves by the law of the tilted facet") {
    const double p = fresnel(std::cos(tilt), 1.82, 1.0).unpolarised();
    std::uint64_t reflected = 0;
    double worst = 0.0;
    for (std::uint64_t k = 0; k < kRays; ++k) {
      Rng rng(12, StreamKind::other, 0, k);
      Ray ray = arriving(Side::inside, 0.0);
      const double x = 32 * rng.uniform(), y = 4 * rng.uniform();
      const HeightFieldExit exit = field.follow(ray, Side::inside, x, y, kCrystalInAir, rng);
      const double angle = exit.side == Side::inside ? 2.0 * tilt : std::asin(1.82 * std::sin(tilt)) - tilt;
      worst = std::max(worst, std::abs(std::hypot(ray.direction.x(), ray.direction.y()) - std::sin(angle)));
      worst = std::max(worst, std::abs(exit.first_slope_rad - tilt));
      reflected += exit.side == Side::inside ? 1 : 0;
    }
    CHECK(worst < 1e-6);  // heights are single precision
    CHECK(std::abs(static_cast<double>(reflected) / kRays - p) <= 4.0 * std::sqrt(p * (1.0 - p) / kRays));
  }

  SUBCASE("oblique incidence: facets are hit in the ratio of their areas projected along the beam") {
    const double incidence = 50.0 * kDegree;
    // Bent by a slightly denser medium: by (n2/n1 - 1) tan(angle to the facet's normal), which is
    // 40 deg on one slope and 60 deg on the other.
    const IndexPair nearly{1.0, 1.001};
    std::uint64_t facing = 0, hit = 0;
    for (std::uint64_t k = 0; k < kRays; ++k) {
      Rng rng(13, StreamKind::other, 0, k);
      Ray ray = arriving(Side::inside, incidence);
      const Vec3 before = ray.direction;
      const double x = 32 * rng.uniform(), y = 4 * rng.uniform();
      if (field.follow(ray, Side::inside, x, y, nearly, rng).facet_interactions != 1) continue;
      ++hit;
      facing += (ray.direction - before).norm() < 0.001 * std::tan(incidence) ? 1 : 0;
    }
    // Areas seen: (1 +- tan(tilt) tan(incidence)) / 2; the facets whose normal leans along the ray
    // are the larger ones.
    const double p = 0.5 * (1.0 + std::tan(tilt) * std::tan(incidence));
    CHECK(hit == kRays);
    CHECK(std::abs(static_cast<double>(facing) / kRays - p) <= 4.0 * std::sqrt(p * (1.0 - p) / kRays));
  }
}

TEST_CASE("whatever the relief, a ray's side and its direction agree, on both sides up to 89.9 deg") {
  std::vector<float> spikes;
  Rng heights(5, StreamKind::other, 0);
  for (int k = 0; k < 37 * 23; ++k)
    spikes.push_back(static_cast<float>(4.0 * std::pow(heights.uniform(), 4)));
  const HeightField field(spikes, 37, 23, 1.0, 0.7);  // slopes to 75 deg and more
  std::uint64_t disagree = 0, cut = 0, without_facet = 0;
  for (const Side side : {Side::inside, Side::outside})
    for (const double degrees : {0.0, 45.0, 80.0, 89.0, 89.9}) {
      for (std::uint64_t k = 0; k < 4000; ++k) {
        Rng rng(14, StreamKind::other, static_cast<std::uint64_t>(degrees * 10), k);
        Ray ray = arriving(side, degrees * kDegree, kTwoPi * rng.uniform());
        const double x = 37 * rng.uniform(), y = 16 * rng.uniform();
        const HeightFieldExit exit = field.follow(ray, side, x, y, kCrystalInAir, rng);
        disagree += (ray.direction.z() > 0.0) != (exit.side == Side::outside) ? 1 : 0;
        cut += exit.cut ? 1 : 0;
        without_facet += exit.facet_interactions < 1 ? 1 : 0;
      }
    }
  CHECK(disagree == 0);
  CHECK(cut == 0);
  CHECK(without_facet == 0);
}

TEST_CASE("a vertical ray along pixel edges and a ray in the mean plane are traced too") {
  const HeightField field = roofs(0.2);
  for (const Side side : {Side::inside, Side::outside}) {
    Rng rng(15, StreamKind::other, 0);
    Ray vertical = arriving(side, 0.0);
    CHECK(field.follow(vertical, side, 3.0, 2.0, kCrystalInAir, rng).facet_interactions >= 1);
    Ray level{{1.0, 0.0, 0.0}, Vec3::Zero()};
    const HeightFieldExit exit = field.follow(level, side, 3.0, 2.0, kCrystalInAir, rng);
    CHECK((level.direction.z() > 0.0) == (exit.side == Side::outside));
  }
}

TEST_CASE("height fields that cannot be are refused") {
  CHECK_THROWS_AS(HeightField({0, 0, 0}, 3, 1, 1, 1), InputError);
  CHECK_THROWS_AS(HeightField({0, 0, 0}, 2, 2, 1, 1), InputError);
  CHECK_THROWS_AS(HeightField({0, 0, 0, std::nanf("")}, 2, 2, 1, 1), InputError);
  CHECK_THROWS_AS(HeightField({0, 0, 0, 0}, 2, 2, 0.0, 1), InputError);
}
