#include "scintray/topography/prepare.hpp"
#include "support/words.hpp"

#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "scintray/core/error.hpp"
#include "scintray/topography/detail/missing_points.hpp"
#include "scintray/topography/map_statistics.hpp"
#include "scintray/topography/preparation.hpp"
#include "scintray/topography/synthesis.hpp"
#include "topography/made_maps.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::topography;
using namespace scintray::test;

namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

/// Weighted least squares of a line through the points of a window, the textbook way.
double regression(const std::vector<double>& line, int at, double half_width) {
  Eigen::MatrixXd design(line.size(), 2);
  Eigen::VectorXd weights(line.size()), heights(line.size());
  for (int k = 0; k < static_cast<int>(line.size()); ++k) {
    const double u = std::abs(k - at) / half_width;
    const bool known = !std::isnan(line[static_cast<std::size_t>(k)]);
    weights[k] = known && u < 1.0 ? std::pow(1.0 - std::pow(u, 3), 3) : 0.0;
    heights[k] = known ? line[static_cast<std::size_t>(k)] : 0.0;
    design.row(k) << 1.0, k - at;
  }
  const Eigen::MatrixXd weighted = weights.asDiagonal() * design;
  return (design.transpose() * weighted).ldlt().solve(weighted.transpose() * heights)[0];
}

}  // namespace

TEST_CASE("LOESS is the tricube-weighted local regression, at ends and gaps too") {
  Rng rng(7, StreamKind::other, 0);
  HeightMap map = test::map_of(40, 3, 0.5, [&](double, double) { return rng.uniform(); });
  map.at(10, 1) = map.at(11, 1) = kNothing;
  const HeightMap before = map;
  filter_loess_lines(map, 4.3);
  for (std::uint32_t j = 0; j < 3; ++j) {
    const std::vector<double> line(&before.heights_um[j * 40], &before.heights_um[j * 40] + 40);
    for (std::uint32_t i = 0; i < 40; ++i) {
      if (std::isnan(before.at(i, j)))
        CHECK(std::isnan(map.at(i, j)));
      else
        CHECK(map.at(i, j) == doctest::Approx(regression(line, static_cast<int>(i), 4.3)).epsilon(1e-10));
    }
  }
  CHECK(map.steps.back() == "LOESS along lines, width 4.3 um");
}

TEST_CASE("LOESS keeps a slope and damps a tip's oscillation by its transfer function") {
  constexpr double kPitch = 0.175, kPeriod = 1.05, kWidth = 3.0;  // six points a period
  HeightMap map = test::map_of(
      300, 1, kPitch, [&](double x, double) { return 0.2 * x + 0.05 * std::sin(kTwoPi * x / kPeriod); });
  filter_loess_lines(map, kWidth);
  double weights = 0.0, passed = 0.0;
  for (int k = -8; k <= 8; ++k) {
    const double u = std::abs(k) * kPitch / (0.5 * kWidth), weight = std::pow(1.0 - u * u * u, 3);
    weights += weight;
    passed += weight * std::cos(kTwoPi * k * kPitch / kPeriod);
  }
  const double transfer = passed / weights;
  CHECK(std::abs(transfer) < 0.03);
  for (std::uint32_t i = 10; i < 290; ++i) {
    const double x = i * kPitch;
    CHECK(map.at(i, 0) ==
          doctest::Approx(0.2 * x + transfer * 0.05 * std::sin(kTwoPi * x / kPeriod)).epsilon(1e-9));
  }
}

TEST_CASE("levelling fits the points that are there, and refuses when they do not determine the polynomial") {
  const auto curve = [](double x, double y) { return 3.0 + 0.2 * x - 0.1 * y + 0.01 * x * y - 0.03 * y * y; };
  HeightMap map = test::map_of(30, 20, 1.0, curve);
  Rng rng(8, StreamKind::other, 0);
  for (double& height : map.heights_um)
    if (rng.uniform() < 0.6) height = kNothing;
  const std::uint64_t missing = count_missing(map);
  level_polynomial(map, 2);
  CHECK(count_missing(map) == missing);
  for (const double height : map.heights_um)
    if (!std::isnan(height)) CHECK(std::abs(height) < 1e-10);

  CHECK(contains(complaint_of([&] { level_polynomial(map, 9); }), "expected 0 to 8"));
  HeightMap line = test::map_of(30, 20, 1.0, curve);
  for (std::uint32_t j = 0; j < 20; ++j)
    for (std::uint32_t i = 0; i < 30; ++i)
      if (j != 4) line.at(i, j) = kNothing;
  CHECK(contains(complaint_of([&] { level_plane(line); }), "do not determine"));
  HeightMap three = test::map_of(3, 3, 1.0, curve);
  CHECK(contains(complaint_of([&] { level_polynomial(three, 3); }), "too small for degree 3"));
  HeightMap none = test::map_of(3, 3, 1.0, [](double, double) { return kNothing; });
  CHECK(contains(complaint_of([&] { level_plane(none); }), "every point is missing"));
  CHECK(contains(complaint_of([&] { subtract_mean(none); }), "every point is missing"));
}

TEST_CASE("filters leave missing points missing and take nothing from them") {
  HeightMap map = test::map_of(20, 20, 1.0, [](double, double) { return 2.0; });
  map.at(4, 5) = kNothing;
  for (const auto filter :
       {+[](HeightMap& m) { filter_gaussian(m, 1.5); }, +[](HeightMap& m) { filter_median(m, 2); },
        +[](HeightMap& m) { filter_loess_lines(m, 5.0); }}) {
    HeightMap filtered = map;
    filter(filtered);
    CHECK(count_missing(filtered) == 1);
    CHECK(std::isnan(filtered.at(4, 5)));
    CHECK(map_statistics(filtered).sz_um < 1e-12);
  }
}

TEST_CASE("a crop keeps its points, in points or in lengths, and nothing outside the map") {
  const auto place = [](double x, double y) { return 100.0 * x + y; };
  HeightMap map = test::map_of(10, 8, 0.5, place);
  map.periodic = true;
  HeightMap lengths = map;
  crop(map, {2, 1, 5, 6});
  CHECK(map.columns == 5);
  CHECK(map.rows == 6);
  CHECK_FALSE(map.periodic);
  for (std::uint32_t j = 0; j < 6; ++j)
    for (std::uint32_t i = 0; i < 5; ++i) CHECK(map.at(i, j) == place(0.5 * (i + 2), 0.5 * (j + 1)));
  CHECK(map.steps.back() == "cropped to 5 x 6 points from column 2, row 1");
  CHECK(crop_box_um(lengths, 1.0, 0.4, 2.6, 3.1) == CropBox{2, 1, 5, 6});

  for (const CropBox box :
       {CropBox{0, 0, 11, 8}, {6, 0, 5, 8}, {0, 8, 10, 2}, {0, 0, 1, 8}, {4294967295u, 0, 3, 3}})
    CHECK(contains(complaint_of([&] { crop(lengths, box); }), "inside the map of 10 x 8"));
  CHECK_THROWS_AS(crop_box_um(lengths, -1.0, 0.0, 1.0, 1.0), InputError);
}

TEST_CASE("a span of LOESS that holds no line, or is wider than one, is refused with the widths that do") {
  HeightMap map = test::map_of(40, 3, 0.5, [](double x, double) { return x; });
  CHECK(contains(complaint_of([&] { filter_loess_lines(map, 1.0); }), "more than two pitches, 1 um"));
  CHECK(contains(complaint_of([&] { filter_loess_lines(map, 20.5); }), "not more than a line, 20 um"));
  CHECK(contains(complaint_of([&] { filter_loess_lines(map, std::nan("")); }), "LOESS width of nan"));
}

TEST_CASE("outliers are found beside a rough surface, and on a flat one; the surface stays") {
  SynthesisRecipe recipe;
  recipe.columns = recipe.rows = 200;
  recipe.gaussian.rms_height_um = 0.5;
  recipe.gaussian.correlation_length_um = 1.0;
  HeightMap map = synthesize(recipe);
  const HeightMap before = map;
  map.at(20, 30) += 4.0;
  map.at(150, 90) -= 4.0;
  map.at(7, 7) = kNothing;
  CHECK(remove_outliers(map, 8.0) == 2);
  CHECK(std::isnan(map.at(20, 30)));
  CHECK(std::isnan(map.at(150, 90)));
  CHECK(count_missing(map) == 3);
  HeightMap sound = before;
  CHECK(remove_outliers(sound, 8.0) == 0);
  CHECK(sound.heights_um == before.heights_um);

  HeightMap flat = test::map_of(20, 20, 1.0, [](double, double) { return 2.0; });
  CHECK(remove_outliers(flat, 6.0) == 0);
  flat.at(3, 3) = 9.0;
  CHECK(remove_outliers(flat, 6.0) == 1);
  CHECK(std::isnan(flat.at(3, 3)));
  CHECK_THROWS_AS(remove_outliers(flat, 0.5), InputError);
  CHECK_THROWS_AS(remove_outliers(flat, std::nan("")), InputError);
  CHECK_THROWS_AS(remove_outliers(flat, 6.0, 0), InputError);
}

TEST_CASE("gaps are filled by the solution of Laplace's equation") {
  // A saddle x^2 - y^2 and a plane are harmonic, on the grid too: they come back exactly.
  const auto harmonic = [](double x, double y) { return 0.3 * x - 0.2 * y + 0.05 * (x * x - y * y); };
  HeightMap map = test::map_of(40, 30, 0.5, harmonic);
  for (std::uint32_t j = 5; j < 25; ++j)
    for (std::uint32_t i = 8; i < 31; ++i)
      if ((i + j) % 7 != 0) map.at(i, j) = kNothing;
  const std::uint64_t missing = count_missing(map);
  fill_missing(map);
  for (std::uint32_t j = 0; j < 30; ++j)
    for (std::uint32_t i = 0; i < 40; ++i)
      CHECK(map.at(i, j) == doctest::Approx(harmonic(0.5 * i, 0.5 * j)).epsilon(1e-10));
  CHECK(map.steps.back() == std::to_string(missing) + " missing points filled by Laplace interpolation");
}

TEST_CASE("gaps at an edge end level, wrap around on a periodic map, and know unequal pitches") {
  HeightMap edge = test::map_of(6, 3, 1.0, [](double x, double) { return x < 2.5 ? x : kNothing; });
  fill_missing(edge);
  for (std::uint32_t j = 0; j < 3; ++j)
    for (std::uint32_t i = 3; i < 6; ++i) CHECK(edge.at(i, j) == doctest::Approx(2.0));
  HeightMap ring = test::map_of(6, 3, 1.0, [](double x, double) { return x < 2.5 ? x : kNothing; });
  ring.periodic = true;
  fill_missing(ring);
  for (std::uint32_t i = 3; i < 6; ++i) CHECK(ring.at(i, 1) == doctest::Approx(2.0 - 0.5 * (i - 2)));

  HeightMap point = test::map_of(3, 3, 1.0, [](double x, double y) {
    return x == 1 && y == 1 ? kNothing : x == 1 ? 1.0 : 0.0;
  });
  point.pitch_y_um = 0.5;
  fill_missing(point);
  CHECK(point.at(1, 1) == doctest::Approx(4.0 / 5.0));  // weights 1 / pitch^2: 2 x 1 along x, 2 x 4 along y
}

TEST_CASE("a large map with most of its points missing is filled within the heights it has") {
  HeightMap map =
      test::map_of(918, 256, 0.1, [](double x, double y) { return std::sin(x) * std::cos(0.7 * y); });
  Rng rng(9, StreamKind::other, 0);
  for (std::uint32_t j = 0; j < map.rows; ++j)
    for (std::uint32_t i = 0; i < map.columns; ++i)
      if (rng.uniform() < 0.7 || (i > 300 && i < 700 && j > 40 && j < 200)) map.at(i, j) = kNothing;
  const MapStatistics before = map_statistics(map);
  CHECK(before.missing > 160'000);
  fill_missing(map);
  CHECK(count_missing(map) == 0);
  const auto [low, high] = std::minmax_element(map.heights_um.begin(), map.heights_um.end());
  CHECK(*high - *low <= before.sz_um + 1e-9);
  CHECK_NOTHROW(make_height_field(map));
}

TEST_CASE("a map without any height cannot be filled, and one with gaps is no surface yet") {
  HeightMap none = test::map_of(4, 4, 1.0, [](double, double) { return kNothing; });
  CHECK(contains(complaint_of([&] { fill_missing(none); }), "every point is missing"));
  CHECK(contains(complaint_of([&] { remove_outliers(none, 6.0); }), "every point is missing"));
  HeightMap holed = test::map_of(4, 4, 1.0, [](double x, double) { return x; });
  holed.at(1, 1) = kNothing;
  CHECK(contains(complaint_of([&] { make_height_field(holed); }), "fill"));
  const std::size_t steps = holed.steps.size();
  fill_missing(holed);
  fill_missing(holed);  // nothing is left to do, and nothing is stated
  CHECK(holed.steps.size() == steps + 1);
}

TEST_CASE("a preparation does its steps in order, and each leaves a line") {
  HeightMap map =
      test::map_of(60, 50, 0.2, [](double x, double y) { return 0.1 * x - 0.3 * y + 0.05 * std::sin(x); });
  map.at(30, 20) = 40.0;
  Preparation preparation;
  preparation.crop = CropLengths{1.0, 0.0, 10.0, 9.0};
  preparation.outlier_limit = 10.0;
  preparation.fill_missing = true;
  preparation.median_radius = 1;
  preparation.loess_width_um = 1.0;
  preparation.gaussian_um = 0.3;
  preparation.leveling = {Leveling::Kind::polynomial, 2};
  prepare(map, preparation);
  REQUIRE(map.steps.size() == 7);
  for (const auto& [step, part] : {std::pair{0, "cropped to 50 x 45"},
                                   {1, "1 outliers"},
                                   {2, "1 missing points filled"},
                                   {3, "median"},
                                   {4, "LOESS"},
                                   {5, "Gaussian"},
                                   {6, "polynomial of degree 2"}})
    CHECK(contains(map.steps[static_cast<std::size_t>(step)], part));
  CHECK(map_statistics(map).sz_um < 1.0);
}
