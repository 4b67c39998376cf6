#pragma once
/// Numbers that describe a height map.

#include <cstdint>

#include "scintray/core/statistics.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/topography/height_map.hpp"

namespace scintray {

/// Height and slope statistics over the pixels of a map as it is (ISO 25178-2:2012, 4.1 for Sa, Sq
/// and Sz), heights from their mean. Slopes are those of neighbouring pixels.
struct MapStatistics {
  double sa_um = 0.0;        ///< mean absolute height
  double sq_um = 0.0;        ///< root mean square height
  double sz_um = 0.0;        ///< highest minus lowest
  double highest_um = 0.0;   ///< above the mean
  double lowest_um = 0.0;    ///< above the mean: negative
  double rms_slope_x = 0.0;  ///< root mean square of dz/dx
  double rms_slope_y = 0.0;
  double mean_slope_rad = 0.0;  ///< mean angle of the triangles to the mean plane, by projected area
};

MapStatistics map_statistics(const HeightMap& map);

/// Mean angle (rad) between the mean normal and the first facet met by a parallel beam at an
/// incidence angle in [0, 90 deg), averaged over position and azimuth, with its standard error.
Estimate mean_slope_met(const HeightField& field, Side side, double incidence_rad, std::uint64_t rays = 20000,
                        std::uint64_t seed = 1);

/// The incidence at which "grazing" slopes of recipes are stated: 88.5 deg.
inline constexpr double kGrazingStated_rad = 88.5 * kDegree;

}  // namespace scintray
