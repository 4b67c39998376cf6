#include "scintray/topography/fit_recipe.hpp"
#include "scintray/topography/synthesis.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "scintray/core/error.hpp"
#include "scintray/topography/map_statistics.hpp"

using namespace scintray;

namespace {
double met(const HeightField& field, Side side, double degrees) {
  return mean_slope_met(field, side, degrees * kDegree).value / kDegree;
}
}  // namespace

TEST_CASE("the ground recipe meets 18 deg at normal and 35 deg at grazing incidence within +-3 um") {
  const HeightMap map = synthesize(ground_recipe());
  const MapStatistics s = map_statistics(map);
  CHECK(s.highest_um < 3.0);
  CHECK(s.lowest_um > -3.0);
  CHECK(s.sz_um > 4.0);
  const HeightField field = make_height_field(map);
  for (const Side side : {Side::inside, Side::outside}) {
    CHECK(std::abs(met(field, side, 0.0) - 18.0) < 1.0);
    CHECK(std::abs(met(field, side, kGrazingStated_rad / kDegree) - 35.0) < 3.0);
  }
}

TEST_CASE("the polished recipe meets 1.25 deg at any incidence within +-0.05 um") {
  const HeightMap map = synthesize(polished_recipe());
  const MapStatistics s = map_statistics(map);
  CHECK(s.highest_um < 0.056);  // about +-0.05
  CHECK(s.lowest_um > -0.056);
  const HeightField field = make_height_field(map);
  for (const double degrees : {0.0, 45.0, 80.0})
    CHECK(std::abs(met(field, Side::inside, degrees) - 1.25) < 0.05);
}

TEST_CASE("a Gaussian relief has its rms height and the slope of its correlation length") {
  SynthesisRecipe recipe;
  recipe.gaussian = {0.5, 4.0};
  const MapStatistics s = map_statistics(synthesize(recipe));
  CHECK(s.sq_um == doctest::Approx(0.5).epsilon(1e-9));
  // rms slope sqrt(2) Sq / T of the autocorrelation exp(-r^2/T^2). The map holds about
  // (90/4)^2 / pi = 160 independent patches, so the rms is known to 1/sqrt(2 * 160) = 6 %.
  CHECK(s.rms_slope_x == doctest::Approx(std::sqrt(2.0) * 0.5 / 4.0).epsilon(0.24));
  CHECK(s.rms_slope_y == doctest::Approx(std::sqrt(2.0) * 0.5 / 4.0).epsilon(0.24));
}

TEST_CASE("a recipe makes one map, and another seed another") {
  SynthesisRecipe recipe = ground_recipe();
  recipe.columns = recipe.rows = 100;
  const HeightMap map = synthesize(recipe);
  CHECK(map.periodic);
  CHECK(synthesize(recipe).heights_um == map.heights_um);
  recipe.seed = 2;
  CHECK(synthesize(recipe).heights_um != map.heights_um);
}

TEST_CASE("a synthesized map goes on over its edges as it does inside") {
  SynthesisRecipe recipe = ground_recipe();
  recipe.columns = recipe.rows = 120;
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

TEST_CASE("a fit finds the rms height for a slope") {
  SynthesisRecipe recipe = polished_recipe();
  recipe.columns = recipe.rows = 128;
  const SynthesisRecipe fitted = fit_recipe(recipe, {3.0 * kDegree, 0.0});
  CHECK(std::abs(met(make_height_field(synthesize(fitted)), Side::inside, 0.0) - 3.0) < 0.1);
}
