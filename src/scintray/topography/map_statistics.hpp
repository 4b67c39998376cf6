#pragma once
/// Statistics of height maps.

#include <array>
#include <cstdint>

#include "scintray/core/statistics.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/topography/height_map.hpp"

namespace scintray::topography {

/// Height and slope statistics of a map (ISO 25178-2:2012, 4.1 and 4.3), heights relative to their
/// mean; missing points are left out. Slopes are those of neighbouring points and of the two
/// triangles of each cell, as light hits them; a periodic map continues across its edges.
struct MapStatistics {
  std::uint64_t points = 0;   ///< with a height
  std::uint64_t missing = 0;  ///< without
  double sa_um = 0.0;         ///< mean absolute height
  double sq_um = 0.0;         ///< root mean square height
  double sz_um = 0.0;         ///< highest minus lowest
  double highest_um = 0.0;    ///< above the mean
  double lowest_um = 0.0;     ///< above the mean: negative
  double ssk = 0.0;           ///< skewness; 0 for a flat map
  double sku = 0.0;           ///< kurtosis, 3 for Gaussian heights; 0 for a flat map
  double sdq = 0.0;           ///< root mean square gradient
  double sdr = 0.0;           ///< developed area over projected area, less 1
  double rms_slope_x = 0.0;   ///< root mean square of dz/dx
  double rms_slope_y = 0.0;
  double mean_slope_rad = 0.0;  ///< mean angle of the triangles to the mean plane, by projected area
  double rms_slope_rad = 0.0;   ///< root mean square of that angle
  /// Share of the projected area whose angle to the mean plane lies between k and k + 1 deg.
  std::array<double, 90> slope_histogram{};
  /// Rms slope over two pitches as a share of the rms slope over one: sqrt((1 + r) / 2) for slopes
  /// whose neighbours have the correlation r. 1: resolved; 0.71: uncorrelated slopes; 0: zigzag.
  double slope_ratio_at_two_pitches = 1.0;
};

/// Statistics of a map. InputError when the map has no point with a height.
MapStatistics map_statistics(const HeightMap& map);

/// Mean visible slope: mean angle (rad) between the mean normal and the first facet hit by a parallel beam at
/// an incidence angle in [0, 90 deg), averaged over position and azimuth, with its standard error. Runs on
/// all threads of the calling task arena; the result is the same for any number of them.
core::Estimate mean_visible_slope(const optics::HeightField& field, optics::Side side, double incidence_rad,
                                  std::uint64_t rays = 20000, std::uint64_t seed = 1);

/// Incidence angle (rad) of the "grazing" slopes of recipes: 88.5 deg.
inline constexpr double kGrazingStated_rad = 88.5 * core::kDegree;

}  // namespace scintray::topography
