#include "scintray/topography/synthesis.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "scintray/core/error.hpp"
#include "scintray/topography/map_statistics.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::topography;

namespace {

double visible_slope_deg(const SynthesisRecipe& recipe, double incidence_rad) {
  return mean_visible_slope(make_height_field(synthesize(recipe)), Side::inside, incidence_rad, 40000).value /
         kDegree;
}

SynthesisRecipe small(SynthesisRecipe recipe) {
  recipe.columns = recipe.rows = 96;
  recipe.gaussian.correlation_length_um = std::min(recipe.gaussian.correlation_length_um, 3.0);
  recipe.scratches.length_um = 8.0;
  return recipe;
}

}  // namespace

TEST_CASE("a fit finds the rms height for a slope, from far away too") {
  for (const double start : {1.0, 8.0}) {
    SynthesisRecipe recipe = small(polished_recipe());
    recipe.gaussian.rms_height_um *= start;
    CHECK(visible_slope_deg(fit_recipe(recipe, {3.0 * kDegree}), 0.0) == doctest::Approx(3.0).epsilon(0.02));
  }
}

TEST_CASE("a fit finds rise, exponent and relief for two slopes and a height, for any seed") {
  for (const std::uint64_t seed : {1, 2}) {
    SynthesisRecipe recipe = ground_recipe();
    recipe.columns = recipe.rows = 128;
    recipe.gaussian.correlation_length_um = 5.0;
    recipe.gaussian.rms_height_um = 0.25;
    recipe.seed = seed;
    const SlopeTarget target{18.0 * kDegree, 33.0 * kDegree, 0.35, 1};
    const SynthesisRecipe fitted = fit_recipe(recipe, target);
    CAPTURE(seed);
    CHECK(visible_slope_deg(fitted, 0.0) == doctest::Approx(18.0).epsilon(0.02));
    CHECK(visible_slope_deg(fitted, kGrazingStated_rad) == doctest::Approx(33.0).epsilon(0.02));
    CHECK(map_statistics(synthesize(fitted)).sq_um == doctest::Approx(0.35).epsilon(0.02));
  }
}

TEST_CASE("a fit to the mean of several seeds has the target on their mean") {
  const SynthesisRecipe fitted = fit_recipe(small(polished_recipe()), {2.0 * kDegree, 0.0, 0.0, 3});
  double sum = 0.0;
  for (SynthesisRecipe one = fitted; one.seed < fitted.seed + 3; ++one.seed)
    sum += visible_slope_deg(one, 0.0);
  CHECK(sum / 3 == doctest::Approx(2.0).epsilon(0.02));
}

TEST_CASE("targets that a recipe has no part for, or cannot reach, are refused") {
  const auto complaint = [](const SynthesisRecipe& recipe, const SlopeTarget& target) {
    try {
      fit_recipe(small(recipe), target);
    } catch (const InputError& error) {
      return error.problems().front().text();
    }
    return std::string("accepted");
  };
  CHECK(complaint(polished_recipe(), {2.0 * kDegree, 9.0 * kDegree}).find("no fracture") !=
        std::string::npos);
  CHECK(complaint(polished_recipe(), {2.0 * kDegree, 0.0, 0.3}).find("no Gaussian relief beside") !=
        std::string::npos);
  CHECK(complaint(polished_recipe(), {0.0}).find("normal incidence") != std::string::npos);
  CHECK(complaint({}, {2.0 * kDegree}).find("neither a fracture") != std::string::npos);
  // Grazing light hits steeper facets than light of normal incidence.
  CHECK(complaint(ground_recipe(), {18.0 * kDegree, 10.0 * kDegree}).find("not the targets") !=
        std::string::npos);
}
