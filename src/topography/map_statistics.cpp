#include "scintray/topography/map_statistics.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/core/vec.hpp"

namespace scintray {

namespace {

/// Mean squares of the differences of neighbours, per pitch.
double rms_slope(const HeightMap& map, std::uint32_t step_x, std::uint32_t step_y, double pitch) {
  double sum = 0.0, count = 0.0;
  for (std::uint32_t j = 0; j + step_y < map.rows; ++j)
    for (std::uint32_t i = 0; i + step_x < map.columns; ++i) {
      const double slope = (map.at(i + step_x, j + step_y) - map.at(i, j)) / pitch;
      sum += slope * slope;
      count += 1.0;
    }
  return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

/// Over both triangles of each cell, which have equal projected areas.
double mean_slope(const HeightMap& map) {
  double sum = 0.0, count = 0.0;
  for (std::uint32_t j = 0; j + 1 < map.rows; ++j)
    for (std::uint32_t i = 0; i + 1 < map.columns; ++i) {
      const double z00 = map.at(i, j), z10 = map.at(i + 1, j), z01 = map.at(i, j + 1),
                   z11 = map.at(i + 1, j + 1);
      sum += std::atan(std::hypot((z10 - z00) / map.pitch_x_um, (z01 - z00) / map.pitch_y_um));
      sum += std::atan(std::hypot((z11 - z01) / map.pitch_x_um, (z11 - z10) / map.pitch_y_um));
      count += 2.0;
    }
  return count > 0.0 ? sum / count : 0.0;
}

}  // namespace

MapStatistics map_statistics(const HeightMap& map) {
  MapStatistics result;
  if (map.heights_um.empty()) return result;
  const double n = static_cast<double>(map.heights_um.size());
  double mean = 0.0;
  for (const double h : map.heights_um) mean += h / n;
  for (const double h : map.heights_um) {
    result.sa_um += std::abs(h - mean) / n;
    result.sq_um += (h - mean) * (h - mean) / n;
  }
  result.sq_um = std::sqrt(result.sq_um);
  const auto [low, high] = std::minmax_element(map.heights_um.begin(), map.heights_um.end());
  result.highest_um = *high - mean;
  result.lowest_um = *low - mean;
  result.sz_um = *high - *low;
  result.rms_slope_x = rms_slope(map, 1, 0, map.pitch_x_um);
  result.rms_slope_y = rms_slope(map, 0, 1, map.pitch_y_um);
  result.mean_slope_rad = mean_slope(map);
  return result;
}

Estimate mean_slope_met(const HeightField& field, Side side, double incidence_rad, std::uint64_t rays,
                        std::uint64_t seed) {
  Moments slopes;
  const double up = side == Side::inside ? 1.0 : -1.0;
  const IndexPair straight_on{1.0, 1.0};
  for (std::uint64_t k = 0; k < rays; ++k) {
    Rng rng(seed, StreamKind::other, static_cast<std::uint64_t>(side), k);
    const double azimuth = kTwoPi * rng.uniform();
    const double x = field.period_x_um() * rng.uniform(), y = field.period_y_um() * rng.uniform();
    Ray ray{{std::sin(incidence_rad) * std::cos(azimuth), std::sin(incidence_rad) * std::sin(azimuth),
             up * std::cos(incidence_rad)},
            Vec3::Zero()};
    slopes.add(field.follow(ray, side, x, y, straight_on, rng).first_slope_rad);
  }
  return slopes.mean();
}

}  // namespace scintray
