/// Digits of small tables. They are no truth about surfaces: they are here so that a change of what tables
/// contain is noticed, since tables are kept between runs.
///
/// When one of these checks fails because tables were meant to change, raise topography::kTableContentVersion
/// and write the new digits, which the failure prints.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "scintray/topography/build_table.hpp"
#include "scintray/topography/preparation.hpp"
#include "scintray/topography/synthesis.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::topography;

namespace {

constexpr IndexPair kIndex{1.82, 1.0};
/// Above the last digits that mathematics libraries differ in, below anything that is a change.
constexpr double kRelative = 1e-5;

TableSettings small_grid() {
  TableSettings settings;
  settings.incidence_step_rad = 30.0 * kDegree;
  settings.azimuth_step_rad = 90.0 * kDegree;
  settings.rays = 200;
  return settings;
}

/// What a table contains, in a few numbers.
struct Digits {
  std::size_t nodes = 0;
  double reflected = 0.0, absorbed = 0.0;  ///< counts of rays
  double slopes = 0.0, polar = 0.0, azimuth = 0.0;
};

void add(const DirectionQuantiles& directions, Digits& digits) {
  for (const float polar : directions.polar) digits.polar += polar;
  for (const float azimuth : directions.azimuth) digits.azimuth += std::abs(azimuth);
}

Digits digits_of(const SurfaceTable& table) {
  Digits digits;
  for (const TableSlice& slice : table.slices())
    for (const Side side : {Side::inside, Side::outside})
      for (const TableNode& node : slice.nodes(side)) {
        const auto rays = static_cast<double>(node.rays);
        ++digits.nodes;
        digits.reflected += std::round(node.reflectance * rays);
        digits.absorbed += std::round(node.absorptance * rays);
        digits.slopes += node.mean_slope_rad;
        add(node.reflected, digits);
        add(node.transmitted, digits);
      }
  return digits;
}

void check(const Digits& found, const Digits& expected) {
  INFO(fmt::format("kTableContentVersion is {}; found {{{}, {}, {}, {:.9g}, {:.9g}, {:.9g}}}",
                   kTableContentVersion, found.nodes, found.reflected, found.absorbed, found.slopes,
                   found.polar, found.azimuth));
  CHECK(found.nodes == expected.nodes);
  CHECK(found.reflected == expected.reflected);
  CHECK(found.absorbed == expected.absorbed);
  CHECK(found.slopes == doctest::Approx(expected.slopes).epsilon(kRelative));
  CHECK(found.polar == doctest::Approx(expected.polar).epsilon(kRelative));
  CHECK(found.azimuth == doctest::Approx(expected.azimuth).epsilon(kRelative));
}

SynthesisRecipe small_map(SynthesisRecipe recipe) {
  recipe.columns = recipe.rows = 128;
  recipe.pitch_um = 0.25;
  return recipe;
}

SurfaceTable table_of(const HeightMap& map, const TableSettings& settings) {
  return build_table(make_height_field(map), kIndex, settings);
}

}  // namespace

TEST_CASE("tables of recipes have the digits of their content version") {
  SynthesisRecipe scratched = small_map(polished_recipe());
  scratched.scratches.length_um = 8.0;
  SynthesisRecipe spectral = small_map({});
  spectral.k_correlation = {0.2, 2.0, 3.0};
  spectral.spectrum = {{0.1, 1.0}, {0.01, 0.001}};
  check(digits_of(table_of(synthesize(small_map(ground_recipe())), small_grid())),
        {19, 8158, 0, 6.82803905, 2035.46638, 69462.4153});
  check(digits_of(table_of(synthesize(scratched), small_grid())),
        {45, 18789, 0, 1.01587519, 4877.15999, 21126.4843});
  check(digits_of(table_of(synthesize(spectral), small_grid())),
        {18, 8334, 0, 11.5825544, 1948.63116, 74561.176});
}

TEST_CASE("tables with direction, to an error and reciprocal have the digits of their content version") {
  const HeightMap map = synthesize(small_map(ground_recipe()));
  TableSettings directional = small_grid(), exact = small_grid(), reciprocal = small_grid();
  directional.directional = true;
  exact.target_error = 0.01;
  reciprocal.reciprocal = true;
  check(digits_of(table_of(map, directional)), {53, 4825, 0, 18.5615664, 5299.80872, 151440.693});
  check(digits_of(table_of(map, exact)), {31, 32674, 0, 10.4594494, 3322.37522, 115265.711});
  const SurfaceTable kernel = table_of(map, reciprocal);
  double shares = 0.0;
  for (std::size_t k = 0; k < kernel.slices()[0].reciprocal->shares().size(); ++k)
    shares += std::pow(kernel.slices()[0].reciprocal->shares()[k], 2);
  INFO(fmt::format("kTableContentVersion is {}; found {:.9g}", kTableContentVersion, shares));
  CHECK(shares == doctest::Approx(1.0097991).epsilon(kRelative));
}

TEST_CASE("the table of a stack has the digits of its content version") {
  Surface surface;
  surface.microsurface =
      std::make_shared<const HeightField>(make_height_field(synthesize(small_map(ground_recipe()))));
  surface.gap_index = Curve::constant(1.5);
  surface.gap_thickness_um = 10.0;
  surface.gap_absorption_per_mm = Curve::constant(5.0);
  surface.reflector = Reflector{"sheet", Curve::constant(0.9), 0.5};
  surface.reflector->transmittance = Curve::constant(0.05);
  check(digits_of(build_stack_table(surface, {{420.0, kIndex}}, small_grid())),
        {12, 8527, 875, 0, 1070.18335, 55473.0523});
}

TEST_CASE("the table of a prepared height map has the digits of its content version") {
  HeightMap map = synthesize(small_map(ground_recipe()));
  map.periodic = false;
  map.at(5, 7) = std::nan("");
  map.at(40, 41) += 20.0;
  Preparation preparation;
  preparation.crop = CropBox{2, 3, 100, 90};
  preparation.outlier_limit = 8.0;
  preparation.fill_missing = true;
  preparation.median_radius = 1;
  preparation.loess_width_um = 1.5;
  preparation.gaussian_um = 0.2;
  preparation.leveling = {Leveling::Kind::polynomial, 2};
  prepare(map, preparation);
  check(digits_of(table_of(map, small_grid())), {30, 11513, 0, 6.52873314, 3328.39028, 54357.4801});
}
