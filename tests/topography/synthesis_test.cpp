#include "scintray/topography/synthesis.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "scintray/core/error.hpp"
#include "scintray/topography/detail/fourier.hpp"
#include "scintray/topography/detail/relief.hpp"
#include "scintray/topography/map_statistics.hpp"
#include "scintray/topography/map_texture.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::topography;

namespace {
double visible_slope_deg(const HeightField& field, Side side, double degrees) {
  return mean_visible_slope(field, side, degrees * kDegree).value / kDegree;
}
}  // namespace

TEST_CASE(
    "the ground recipe: 18 deg at normal and 35 deg at grazing incidence, within +-3 um, for any seed") {
  for (const std::uint64_t seed : {1, 2, 3}) {
    SynthesisRecipe recipe = ground_recipe();
    recipe.seed = seed;
    const HeightMap map = synthesize(recipe);
    const MapStatistics s = map_statistics(map);
    CAPTURE(seed);
    CHECK(s.highest_um < 3.0);
    CHECK(s.lowest_um > -3.0);
    CHECK(s.sz_um > 4.0);
    CHECK(s.sq_um == doctest::Approx(0.45).epsilon(0.03));
    const HeightField field = make_height_field(map);
    for (const Side side : {Side::inside, Side::outside}) {
      CHECK(std::abs(visible_slope_deg(field, side, 0.0) - 18.0) < 1.0);
      CHECK(std::abs(visible_slope_deg(field, side, kGrazingStated_rad / kDegree) - 35.0) < 3.0);
    }
    CHECK(map_warnings(map, s, map_texture(map)).empty());
  }
}

TEST_CASE("the polished recipe: 1.25 deg at any incidence, within +-0.05 um") {
  const HeightMap map = synthesize(polished_recipe());
  const MapStatistics s = map_statistics(map);
  CHECK(s.highest_um < 0.056);  // about +-0.05
  CHECK(s.lowest_um > -0.056);
  const HeightField field = make_height_field(map);
  for (const double degrees : {0.0, 45.0, 80.0, 85.0})
    CHECK(std::abs(visible_slope_deg(field, Side::inside, degrees) - 1.25) < 0.05);
}

TEST_CASE("a Gaussian relief has its rms height and the slope of its correlation length") {
  SynthesisRecipe recipe;
  recipe.gaussian.rms_height_um = 0.5;
  recipe.gaussian.correlation_length_um = 4.0;
  const MapStatistics s = map_statistics(synthesize(recipe));
  CHECK(s.sq_um == doctest::Approx(0.5).epsilon(1e-9));
  // rms slope sqrt(2) Sq / T of the autocorrelation exp(-r^2/T^2). The map holds about
  // (90/4)^2 / pi = 160 independent patches, so the rms is known to 1/sqrt(2 * 160) = 6 %.
  CHECK(s.rms_slope_x == doctest::Approx(std::sqrt(2.0) * 0.5 / 4.0).epsilon(0.24));
  CHECK(s.rms_slope_y == doctest::Approx(std::sqrt(2.0) * 0.5 / 4.0).epsilon(0.24));
}

TEST_CASE("a recipe makes one map, and another seed another") {
  SynthesisRecipe recipe = ground_recipe();
  recipe.columns = recipe.rows = 180;
  const HeightMap map = synthesize(recipe);
  CHECK(map.periodic);
  CHECK(synthesize(recipe).heights_um == map.heights_um);
  recipe.seed = 2;
  CHECK(synthesize(recipe).heights_um != map.heights_um);
}

TEST_CASE("a synthesized map continues over its edges as it does inside") {
  SynthesisRecipe recipe = ground_recipe();
  recipe.columns = recipe.rows = 180;
  const HeightMap map = synthesize(recipe);
  double inside = 0.0, across = 0.0;
  for (std::uint32_t j = 0; j < map.rows; ++j) {
    across = std::max(across, std::abs(map.at(0, j) - map.at(map.columns - 1, j)));
    for (std::uint32_t i = 1; i < map.columns; ++i)
      inside = std::max(inside, std::abs(map.at(i, j) - map.at(i - 1, j)));
  }
  CHECK(across <= inside);
}

TEST_CASE("recipes out of range are refused, with every fault named") {
  SynthesisRecipe recipe = ground_recipe();
  recipe.pitch_um = -1.0;
  recipe.gaussian.correlation_length_um = 0.0;
  try {
    synthesize(recipe);
    FAIL("accepted");
  } catch (const InputError& error) {
    CHECK(error.problems().size() >= 2);
  }
}

TEST_CASE("saw marks have their lengths along and across, and their direction") {
  SynthesisRecipe recipe;
  recipe.name = "saw_cut";
  recipe.gaussian = {0.8, 2.0, 12.0, 25 * kDegree};
  const HeightMap map = synthesize(recipe);
  CHECK(map_statistics(map).sq_um == doctest::Approx(0.8).epsilon(1e-9));
  const MapTexture texture = map_texture(map);
  REQUIRE(texture.std_rad);
  // Std is where the sum over terms of power cos^2(2 off) off vanishes; terms are exponential deviates
  // about the spectrum. Four standard deviations: one false alarm in 16,000 seeds.
  double variance = 0.0, slope = 0.0;
  for (int l = -60; l <= 60; ++l)
    for (int k = 0; k <= 60; ++k) {
      if (k == 0 && l <= 0) continue;
      const double width = 514 * 0.175, power = gaussian_density(recipe.gaussian, k / width, l / width);
      const double off = std::remainder(std::atan2(l, k) + 0.5 * kPi - 25 * kDegree, kPi);
      if (std::abs(off) > 0.25 * kPi) continue;
      const double weight = std::pow(std::cos(2.0 * off), 2);
      variance += std::pow(power * weight * off, 2);
      slope += power * (weight - 2.0 * off * std::sin(4.0 * off));
    }
  CHECK(std::abs(*texture.std_rad - 25 * kDegree) < 4.0 * std::sqrt(variance) / slope);
  CHECK(4.0 * std::sqrt(variance) / slope < 15 * kDegree);
  // The field holds 90^2 / (pi 2 x 12) = 107 independent patches: lengths are known to some 10 %.
  CHECK(*texture.sal_um == doctest::Approx(2.0 * std::sqrt(std::log(5.0))).epsilon(0.25));
  CHECK(*texture.str < 0.3);
}

TEST_CASE("scratches have the depth, width and number that are set, across the edges of the map too") {
  SynthesisRecipe recipe;
  recipe.columns = recipe.rows = 400;
  recipe.pitch_um = 0.1;
  recipe.scratches = {1600.0 / 15.0, 15.0, 0.04, 0.5};  // a single scratch of 15 um in 40 x 40 um
  const HeightMap one = synthesize(recipe);
  double volume = 0.0, deepest = 0.0, mean = 0.0;
  for (const double h : one.heights_um) mean = std::max(mean, h);  // the floor between, less the mean
  for (const double h : one.heights_um) {
    volume += (mean - h) * 0.01;
    deepest = std::max(deepest, mean - h);
  }
  CHECK(deepest <= 0.04);
  CHECK(deepest > 0.0);
  // Across: depth width sqrt(pi); the two rounded ends add pi width^2 depth. Points of a fifth of the
  // width sum such a bell to within 1 %, wherever they lie.
  const double expected = deepest * (15.0 * 0.5 * std::sqrt(kPi) + kPi * 0.25);
  CHECK(volume == doctest::Approx(expected).epsilon(0.01));

  recipe.scratches.spacing_um = 5.0;
  const HeightMap many = synthesize(recipe);
  CHECK(many.periodic);
  double inside = 0.0, across = 0.0;
  for (std::uint32_t j = 0; j < many.rows; ++j) {
    across = std::max(across, std::abs(many.at(0, j) - many.at(many.columns - 1, j)));
    for (std::uint32_t i = 1; i < many.columns; ++i)
      inside = std::max(inside, std::abs(many.at(i, j) - many.at(i - 1, j)));
  }
  CHECK(across <= inside);
  CHECK(across > 0.0);
}

TEST_CASE("a K-correlation relief has the variance of its spectrum between the width and the pitch") {
  SynthesisRecipe recipe;
  recipe.columns = recipe.rows = 256;
  recipe.pitch_um = 0.2;
  recipe.k_correlation = {0.5, 1.0, 3.0};
  double expected = 0.0, spread = 0.0;
  const double width = 51.2;
  for (int l = -127; l <= 128; ++l)
    for (int k = -127; k <= 128; ++k) {
      if (k == 0 && l == 0) continue;
      const double term =
          k_correlation_density(recipe.k_correlation, std::hypot(k, l) / width) / (width * width);
      expected += term;
      spread += 2.0 * term * term;  // a term and its conjugate are one exponential deviate
    }
  // Five standard deviations of the sum of exponential deviates: one false alarm in a million seeds.
  const double square = std::pow(map_statistics(synthesize(recipe)).sq_um, 2);
  CHECK(std::abs(square - expected) < 5.0 * std::sqrt(spread));
  CHECK(expected < 0.25);
  CHECK(expected > 0.15);
  // The closed form: the integral of 2 pi f S over all f is Sq^2.
  double integral = 0.0;
  for (double x = -12.0; x < 12.0; x += 0.01) {
    const double f = std::exp(x);
    integral += kTwoPi * f * f * k_correlation_density(recipe.k_correlation, f) * 0.01;
  }
  CHECK(integral == doctest::Approx(0.25).epsilon(1e-4));
}

TEST_CASE("a tabulated spectrum comes out as it went in, band by band") {
  SynthesisRecipe recipe;
  recipe.columns = recipe.rows = 512;
  recipe.pitch_um = 0.2;
  recipe.spectrum = {{0.05, 0.5, 2.0}, {0.1, 1e-3, 1e-6}};
  CHECK(tabulated_density(recipe.spectrum, std::sqrt(0.05 * 0.5)) == doctest::Approx(1e-2));
  CHECK(tabulated_density(recipe.spectrum, 2.0) == 1e-6);
  CHECK(tabulated_density(recipe.spectrum, 0.04) == 0.0);
  CHECK(tabulated_density(recipe.spectrum, 2.1) == 0.0);
  CHECK(tabulated_density({{1.0, 3.0}, {2.0, 0.0}}, 2.0) == doctest::Approx(1.0));
  const HeightMap map = synthesize(recipe);
  const HalfSpectrum terms = fourier_transform(map.heights_um, 512, 512);
  const double width = 102.4, n = 512.0 * 512.0;
  for (const auto& band : {std::pair{0.1, 0.2}, {0.2, 0.5}, {0.5, 1.0}, {1.0, 1.9}, {0.01, 0.045}}) {
    const auto& low = band.first;
    const auto& high = band.second;
    double found = 0.0, expected = 0.0, count = 0.0;
    for (std::uint32_t l = 0; l < 512; ++l)
      for (std::uint32_t k = 0; k < terms.kept(); ++k) {
        const double f = std::hypot(spatial_frequency(k, 512, 0.2), spatial_frequency(l, 512, 0.2));
        if (f < low || f >= high) continue;
        found += terms.weight(k) * std::norm(terms.at(k, l)) / (n * n) * width * width;
        expected += terms.weight(k) * tabulated_density(recipe.spectrum, f);
        count += terms.weight(k);
      }
    CAPTURE(low);
    // A sum of count / 2 exponential deviates, with weights that favour the low end of the band.
    if (expected > 0.0) CHECK(found == doctest::Approx(expected).epsilon(5.0 * std::sqrt(8.0 / count)));
    if (expected == 0.0) CHECK(found < 1e-20);
  }
}

TEST_CASE("spectra, scratches and saw marks out of range are refused, each with its fault") {
  const auto complaint = [](const auto& change) {
    SynthesisRecipe recipe;
    recipe.columns = recipe.rows = 64;
    change(recipe);
    try {
      synthesize(recipe);
    } catch (const InputError& error) {
      return error.problems().front().text();
    }
    return std::string("accepted");
  };
  const auto says = [](const std::string& text, const std::string& part) {
    CAPTURE(text);
    return text.find(part) != std::string::npos;
  };
  using Recipe = SynthesisRecipe;
  CHECK(says(complaint([](Recipe& r) { r.spectrum = {{0.1, 0.3, 0.2}, {1, 1, 1}}; }), "expected increasing"));
  CHECK(says(complaint([](Recipe& r) { r.spectrum = {{0.1, 0.2}, {1, -1}}; }), "expected 0 or more"));
  CHECK(says(complaint([](Recipe& r) { r.spectrum = {{0.0, 0.2}, {1, 1}}; }), "expected above 0"));
  CHECK(says(complaint([](Recipe& r) { r.spectrum = {{0.1}, {1}}; }), "single point"));
  CHECK(says(complaint([](Recipe& r) { r.spectrum = {{0.1, 0.2}, {1}}; }), "different length"));
  CHECK(says(complaint([](Recipe& r) { r.k_correlation = {0.1, 1.0, 1.0}; }), "not above 1"));
  CHECK(says(complaint([](Recipe& r) { r.scratches = {5.0, 30.0, 0.1, 0.2}; }), "half the map's width"));
  CHECK(says(complaint([](Recipe& r) { r.scratches = {1e-9, 3.0, 0.1, 0.2}; }), "closer than"));
  CHECK(says(complaint([](Recipe& r) { r.gaussian = {0.1, 2.0, 1.0, 0.0}; }), "along the lay"));
}
