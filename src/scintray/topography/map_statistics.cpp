#include "scintray/topography/map_statistics.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/core/vec.hpp"

namespace scintray::topography {

namespace {

struct MeanSquare {
  double sum = 0.0;
  std::uint64_t count = 0;
  void add(double value) {
    sum += value * value;
    ++count;
  }
  double mean() const { return count > 0 ? sum / static_cast<double>(count) : 0.0; }
};

/// Slopes over `step` pitches between points that have heights, along x or along y.
MeanSquare slopes(const HeightMap& map, bool along_x, std::uint32_t step) {
  const double length = step * (along_x ? map.pitch_x_um : map.pitch_y_um);
  const std::uint32_t step_x = along_x ? step : 0, step_y = along_x ? 0 : step;
  const std::uint32_t columns = map.periodic ? map.columns : map.columns - std::min(map.columns, step_x);
  const std::uint32_t rows = map.periodic ? map.rows : map.rows - std::min(map.rows, step_y);
  MeanSquare result;
  for (std::uint32_t j = 0; j < rows; ++j)
    for (std::uint32_t i = 0; i < columns; ++i) {
      const double slope =
          (map.at((i + step_x) % map.columns, (j + step_y) % map.rows) - map.at(i, j)) / length;
      if (!std::isnan(slope)) result.add(slope);
    }
  return result;
}

void height_statistics(const HeightMap& map, MapStatistics& result) {
  double sum = 0.0, low = INFINITY, high = -INFINITY;
  for (const double h : map.heights_um) {
    if (std::isnan(h)) continue;
    ++result.points;
    sum += h;
    low = std::min(low, h);
    high = std::max(high, h);
  }
  result.missing = map.heights_um.size() - result.points;
  if (result.points == 0)
    throw core::InputError(
        {{}, "height map in which every point is missing; expected at least one height", ""});
  const double n = static_cast<double>(result.points), mean = sum / n;
  double absolute = 0.0, squares = 0.0, cubes = 0.0, fourths = 0.0;
  for (const double h : map.heights_um) {
    if (std::isnan(h)) continue;
    const double z = h - mean;
    absolute += std::abs(z);
    squares += z * z;
    cubes += z * z * z;
    fourths += z * z * z * z;
  }
  result.sa_um = absolute / n;
  result.sq_um = std::sqrt(squares / n);
  result.highest_um = high - mean;
  result.lowest_um = low - mean;
  result.sz_um = high - low;
  if (result.sq_um > 0.0) {
    result.ssk = cubes / n / std::pow(result.sq_um, 3);
    result.sku = fourths / n / std::pow(result.sq_um, 4);
  }
}

/// Over both triangles of each cell, which have equal projected areas; those with a missing corner
/// are left out.
void facet_statistics(const HeightMap& map, MapStatistics& result) {
  const std::uint32_t columns = map.columns - (map.periodic ? 0 : 1);
  const std::uint32_t rows = map.rows - (map.periodic ? 0 : 1);
  double count = 0.0, gradients = 0.0, area = 0.0, angles = 0.0, squares = 0.0;
  const auto facet = [&](double slope_x, double slope_y) {
    const double gradient2 = slope_x * slope_x + slope_y * slope_y;
    if (std::isnan(gradient2)) return;
    const double angle = std::atan(std::sqrt(gradient2));
    count += 1.0;
    gradients += gradient2;
    area += gradient2 / (1.0 + std::sqrt(1.0 + gradient2));  // sqrt(1 + g^2) - 1
    angles += angle;
    squares += angle * angle;
    result.slope_histogram[std::min<std::size_t>(89, static_cast<std::size_t>(angle / core::kDegree))] += 1.0;
  };
  for (std::uint32_t j = 0; j < rows; ++j)
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t right = (i + 1) % map.columns, below = (j + 1) % map.rows;
      const double z00 = map.at(i, j), z10 = map.at(right, j), z01 = map.at(i, below),
                   z11 = map.at(right, below);
      facet((z10 - z00) / map.pitch_x_um, (z01 - z00) / map.pitch_y_um);
      facet((z11 - z01) / map.pitch_x_um, (z11 - z10) / map.pitch_y_um);
    }
  if (count == 0.0) return;
  result.sdq = std::sqrt(gradients / count);
  result.sdr = area / count;
  result.mean_slope_rad = angles / count;
  result.rms_slope_rad = std::sqrt(squares / count);
  for (double& share : result.slope_histogram) share /= count;
}

}  // namespace

MapStatistics map_statistics(const HeightMap& map) {
  MapStatistics result;
  height_statistics(map, result);
  facet_statistics(map, result);
  const MeanSquare x = slopes(map, true, 1), y = slopes(map, false, 1);
  result.rms_slope_x = std::sqrt(x.mean());
  result.rms_slope_y = std::sqrt(y.mean());
  const double one = x.mean() + y.mean();
  const double two = slopes(map, true, 2).mean() + slopes(map, false, 2).mean();
  if (one > 0.0) result.slope_ratio_at_two_pitches = std::sqrt(two / one);
  return result;
}

core::Estimate mean_visible_slope(const optics::HeightField& field, optics::Side side, double incidence_rad,
                                  std::uint64_t rays, std::uint64_t seed) {
  const double up = side == optics::Side::inside ? 1.0 : -1.0;
  const optics::IndexPair straight_on{1.0, 1.0};
  std::vector<double> slopes_seen(rays);
  tbb::parallel_for(std::uint64_t{0}, rays, [&](std::uint64_t k) {
    core::Rng rng(seed, core::StreamKind::other, static_cast<std::uint64_t>(side), k);
    const double azimuth = core::kTwoPi * rng.uniform();
    const double x = field.period_x_um() * rng.uniform(), y = field.period_y_um() * rng.uniform();
    optics::Ray ray{{std::sin(incidence_rad) * std::cos(azimuth), std::sin(incidence_rad) * std::sin(azimuth),
                     up * std::cos(incidence_rad)},
                    core::Vec3::Zero()};
    slopes_seen[k] = field.follow(ray, side, x, y, straight_on, rng).first_slope_rad;
  });
  // In the order of the rays, so that the sum does not depend on the threads.
  core::Moments slopes;
  for (const double slope : slopes_seen) slopes.add(slope);
  return slopes.mean();
}

}  // namespace scintray::topography
