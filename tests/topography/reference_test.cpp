/// Against an independent program's tracing of two height maps, and published maps traced.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

#include "scintray/core/error.hpp"
#include "scintray/core/statistics.hpp"
#include "scintray/topography/detail/missing_points.hpp"
#include "scintray/topography/height_map.hpp"
#include "scintray/topography/map_statistics.hpp"
#include "scintray/topography/prepare.hpp"
#include "scintray/topography/synthesis.hpp"
#include "support/evidence.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::topography;

namespace {

constexpr IndexPair kCrystalInAir{1.82, 1.0};

Estimate reflectance(const HeightField& field, Side side, double incidence, std::uint64_t rays) {
  std::uint64_t reflected = 0;
  for (std::uint64_t k = 0; k < rays; ++k) {
    Rng rng(31, StreamKind::other, static_cast<std::uint64_t>(incidence * 1e6), k);
    Ray ray{{std::sin(incidence), 0.0, (side == Side::inside ? 1.0 : -1.0) * std::cos(incidence)},
            Vec3::Zero()};
    reflected += field.scatter(ray, side, Vec3::UnitZ(), kCrystalInAir, rng) == side ? 1 : 0;
  }
  return binomial_estimate(reflected, rays);
}

struct Reference {
  const char* file;
  std::array<double, 11> reflectance;
  std::vector<std::pair<double, double>> slopes;  // incidence, mean visible slope, deg
};

}  // namespace

TEST_CASE("reflectance and mean visible slopes agree with an independent tracing of two Gaussian maps") {
  constexpr std::array<double, 11> kIncidence{0, 10, 20, 30, 34.5, 39, 45.75, 50.25, 57, 61.5, 70.5};
  const std::array<Reference, 2> references{
      {{"tests/reference/microsurface/gaussian_rough.gsf",
        {0.149, 0.192, 0.327, 0.519, 0.608, 0.698, 0.828, 0.898, 0.970, 0.991, 0.999},
        {{0, 18.2}, {57, 18.2}, {75, 19.3}, {81.75, 20.8}, {88.5, 22.2}}},
       {"tests/reference/microsurface/gaussian_polished.gsf",
        {0.082, 0.086, 0.090, 0.185, 0.928, 1, 1, 1, 1, 1, 1},
        {{0, 1.34}, {57, 1.34}}}}};
  constexpr std::uint64_t kRays = 40000, kReferenceRays = 60000;
  for (const Reference& reference : references) {
    ReadOptions options;
    options.periodic = true;
    const HeightField field = make_height_field(read_height_map(test::source_file(reference.file), options));
    for (std::size_t k = 0; k < kIncidence.size(); ++k) {
      const Estimate ours = reflectance(field, Side::inside, kIncidence[k] * kDegree, kRays);
      const double theirs = reference.reflectance[k];
      const double error = std::hypot(ours.error, std::sqrt(theirs * (1.0 - theirs) / kReferenceRays));
      CAPTURE(reference.file);
      CAPTURE(kIncidence[k]);
      test::evidence(
          "microsurface_reflectance",
          {std::filesystem::path(reference.file).stem().string(), fmt::format("{:g}", kIncidence[k]),
           fmt::format("{:.4f} ± {:.4f}", ours.value, ours.error), fmt::format("{:.3f}", theirs)});
      // Four combined standard errors, and 0.3 % for the rays that the other program misclassified.
      CHECK(std::abs(ours.value - theirs) <= 4.0 * error + 0.003);
    }
    for (const auto& row : reference.slopes) {
      const auto& incidence = row.first;
      const auto& slope = row.second;
      const Estimate ours = mean_visible_slope(field, Side::inside, incidence * kDegree, kRays);
      test::evidence("microsurface_slope",
                     {std::filesystem::path(reference.file).stem().string(), fmt::format("{:g}", incidence),
                      fmt::format("{:.3f} ± {:.3f}", ours.value / kDegree, ours.error / kDegree),
                      fmt::format("{:g}", slope)});
      CAPTURE(incidence);
      CHECK(std::abs(ours.value / kDegree - slope) <=
            4.0 * std::sqrt(2.0) * ours.error / kDegree + 0.05 + 0.003 * slope);
    }
  }
}

TEST_CASE("the Gaussian surface made here reflects as an independent program's, Sq 0.9 um, length 4.8 um") {
  // Figures of that program for a realisation of its own; one realisation varies by about 0.01.
  const std::array<std::pair<double, double>, 8> reference{{{0, 0.149},
                                                            {10, 0.192},
                                                            {20, 0.327},
                                                            {30, 0.519},
                                                            {34.5, 0.608},
                                                            {45.75, 0.828},
                                                            {57, 0.970},
                                                            {70.5, 0.999}}};
  std::vector<HeightField> fields;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SynthesisRecipe recipe;
    recipe.gaussian = {0.9, 4.8};
    recipe.seed = seed;
    fields.push_back(make_height_field(synthesize(recipe)));
  }
  for (const auto& row : reference) {
    const auto& incidence = row.first;
    const auto& expected = row.second;
    double mean = 0.0;
    for (const HeightField& field : fields)
      mean += reflectance(field, Side::inside, incidence * kDegree, 20000).value / 4.0;
    test::evidence("gaussian_reflectance", {fmt::format("{:g}", incidence), fmt::format("{:.4f}", mean),
                                            fmt::format("{:.3f}", expected)});
    CAPTURE(incidence);
    CHECK(std::abs(mean - expected) < 0.015);
  }
}

namespace {

struct PublishedMap {
  const char* file;
  ReadOptions options;
  bool fill = false;
  std::uint64_t rays = 3000;  ///< per side and incidence angle
};

/// For files that state metres of height over micrometres of width, which are refused without.
ReadOptions heights_in_um() {
  ReadOptions options;
  options.height_unit_um = 1.0;
  return options;
}

ReadOptions without_units(double width_um) {
  ReadOptions options;
  options.width_um = width_um;
  options.height_unit_um = 1e-3;
  return options;
}

}  // namespace

// The two text exports of Gwyddion were made up to test readers and rise by metres over micrometres: a ray
// passes millions of facets before it leaves them, or is cut at the step limit, on the side where it is.
TEST_CASE("no ray on any published map is unclassified: side and direction agree up to 89.9 deg") {
  constexpr std::uint64_t kFewRays = 1;
  const std::vector<PublishedMap> maps{{"chip.gsf", {}},
                                       {"chip.gwy", {}},
                                       {"matrix-2.txt.gz", {}},
                                       {"di-3.di", {}},
                                       {"di-5.di", {}},
                                       {"mi-1.mi", {}},
                                       {"P0089OP0027.ibw", {}},
                                       {"x3p-2.x3p", {}},
                                       {"sample-land.x3p", {}, true},
                                       {"sdf-1.sdf", {}},
                                       {"gwyddion-export-english.txt", heights_in_um(), false, kFewRays},
                                       {"gwyddion-export-german.txt", heights_in_um(), false, kFewRays},
                                       {"xyz-1.txt", without_units(4.0)},
                                       {"gwyfile-test.gwy", without_units(128.0)},
                                       {"10x10-one_channel_without_name.ibw", without_units(10.0)}};
  for (const PublishedMap& published : maps) {
    const auto path = test::shared_file(std::string("data/topography/") + published.file);
    if (!path) return;
    HeightMap map = read_height_map(*path, published.options);
    CAPTURE(published.file);
    if (published.fill) {
      CHECK(count_missing(map) > 0);
      CHECK_THROWS_AS(make_height_field(map), InputError);
      fill_missing(map);
    }
    level_plane(map);
    const HeightField field = make_height_field(map);
    std::uint64_t disagree = 0, cut = 0, facets = 0;
    for (const Side side : {Side::inside, Side::outside})
      for (const double degrees : {0.0, 30.0, 60.0, 80.0, 87.0, 89.9})
        for (std::uint64_t k = 0; k < published.rays; ++k) {
          Rng rng(32, StreamKind::other, static_cast<std::uint64_t>(degrees * 10), k);
          const double up = side == Side::inside ? 1.0 : -1.0;
          const double azimuth = kTwoPi * rng.uniform();
          const double sine = std::sin(degrees * kDegree);
          Ray ray{{sine * std::cos(azimuth), sine * std::sin(azimuth), up * std::cos(degrees * kDegree)},
                  Vec3::Zero()};
          const double x = field.period_x_um() * rng.uniform(), y = field.period_y_um() * rng.uniform();
          const HeightFieldExit exit = field.follow(ray, side, x, y, kCrystalInAir, rng);
          disagree += (ray.direction.z() > 0.0) != (exit.side == Side::outside) ? 1 : 0;
          cut += exit.cut ? 1 : 0;
          facets += exit.facet_interactions > 0 ? 1 : 0;
        }
    CHECK(disagree == 0);
    if (published.rays != kFewRays) CHECK(cut == 0);
    CHECK(facets == 2 * 6 * published.rays);
  }
}
