#include "scintray/analysis/goniometer/hemisphere.hpp"

#include <doctest/doctest.h>

#include "scintray/core/sampling.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::analysis;

TEST_CASE("the cells of the hemisphere cover it once and are nearly alike") {
  const HemisphereGrid& grid = hemisphere_grid();
  double sum = 0.0, smallest = 1.0, largest = 0.0;
  for (std::size_t k = 0; k < grid.size(); ++k) {
    const HemisphereGrid::Cell cell = grid.cell(k);
    sum += cell.solid_angle_sr;
    smallest = std::min(smallest, cell.solid_angle_sr);
    largest = std::max(largest, cell.solid_angle_sr);
    const double polar = 0.5 * (cell.polar_low + cell.polar_high);
    for (const double share : {0.01, 0.5, 0.99}) {
      const double azimuth = std::lerp(cell.azimuth_low, cell.azimuth_high, share);
      CHECK(grid.cell_at(polar, azimuth) == k);
      CHECK(grid.cell_at(polar, azimuth - kTwoPi) == k);
    }
  }
  CHECK(sum == doctest::Approx(kTwoPi).epsilon(1e-12));
  CHECK(largest / smallest < 1.1);
  CHECK(grid.cell_at(0.0, 0.0) < 3);
  CHECK(grid.cell_at(0.5 * kPi, 3.0) < grid.size());
}

TEST_CASE("isotropic light fills cells by solid angle, and the profile evenly") {
  // Fixed seeds; each p-value falls below 1e-4 by chance once in 10,000 seeds.
  constexpr std::uint64_t kRays = 400'000;
  const double half_width = 8.0 * kDegree;
  DirectionCounts counts;
  Rng rng(7, StreamKind::other, 0);
  for (std::uint64_t i = 0; i < kRays; ++i) {
    const Vec3 d = sample_isotropic(rng);
    counts.add(d.x(), d.y(), std::abs(d.z()), std::sin(half_width));
  }
  CHECK(counts.total() == kRays);
  std::vector<double> expected;
  for (std::size_t k = 0; k < hemisphere_grid().size(); ++k)
    expected.push_back(kRays * hemisphere_grid().cell(k).solid_angle_sr / kTwoPi);
  CHECK(chi_square_test(counts.cells, expected).p_value > 1e-4);
  std::uint64_t in_plane = 0;
  for (const std::uint64_t count : counts.profile) in_plane += count;
  const double share = DirectionCounts::kProfileBins * profile_bin_sr(half_width) / kTwoPi;
  CHECK(sigmas(binomial_estimate(in_plane, kRays), {share, 0.0}) < 4.0);
  const std::vector<double> level(DirectionCounts::kProfileBins,
                                  static_cast<double>(in_plane) / DirectionCounts::kProfileBins);
  CHECK(chi_square_test(counts.profile, level).p_value > 1e-4);
}

TEST_CASE("the profile is signed: forward light on the right, and only light near the plane") {
  DirectionCounts counts;
  const double sin_half_width = std::sin(5.0 * kDegree);
  const auto add = [&](double in_plane_deg, double across_deg) {
    const double e = across_deg * kDegree, a = in_plane_deg * kDegree;
    counts.add(std::cos(e) * std::sin(a), std::sin(e), std::cos(e) * std::cos(a), sin_half_width);
  };
  add(45.5, 0.0);
  add(45.5, 4.9);
  add(45.5, -4.9);
  add(45.5, 5.1);
  add(-60.5, 0.0);
  CHECK(counts.profile[135] == 3);
  CHECK(counts.profile[29] == 1);
  CHECK(counts.total() == 5);
}
