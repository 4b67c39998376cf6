#pragma once
/// Points of a map without a height (NaN in HeightMap::heights_um): finding outliers, filling gaps.

#include <cstdint>

#include "scintray/topography/height_map.hpp"

namespace scintray::topography {

/// Number of points without a height.
std::uint64_t count_missing(const HeightMap& map);

/// Removes the heights that are farther from the median of the (2 radius + 1)^2 points around
/// them than `limit` robust standard deviations of all such differences: 1.4826 times their median
/// absolute deviation (F. R. Hampel 1974, J. Am. Stat. Assoc. 69, 383), or, where more than half of
/// the differences are equal, 1.2533 times their mean absolute deviation (B. Iglewicz and D. C.
/// Hoaglin 1993, How to Detect and Handle Outliers, section 3.3). Returns the number removed.
/// InputError when the limit is not at least 1, the radius not in [1, 50], or no point has a height.
std::uint64_t remove_outliers(HeightMap& map, double limit, int radius = 2);

/// Fills every missing point with the height of a membrane stretched over the gap: the solution of Laplace's
/// equation with the points around as boundary, free at the edges of the map (wrapped around on a
/// periodic one), by the five-point formula (Press et al. 2007, Numerical Recipes 3rd ed., section
/// 3.8) and a sparse Cholesky factorization. No filled height exceeds the heights around its gap.
/// InputError when no point has a height, or when more than 4 million are missing.
void fill_missing(HeightMap& map);

}  // namespace scintray::topography
