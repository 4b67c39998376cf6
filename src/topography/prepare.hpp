#pragma once
/// From a raw height map to one that is the surface: levelling and filters. Each leaves a line in
/// the map's steps.

#include <cstdint>

#include "scintray/topography/height_map.hpp"

namespace scintray {

/// Subtracts the mean height.
void subtract_mean(HeightMap& map);

/// Subtracts the least-squares polynomial of total degree `degree` (1: a plane) in x and y.
/// InputError when degree is not in [0, 8] or the map has fewer points than coefficients.
void level_polynomial(HeightMap& map, int degree);

/// Subtracts the least-squares plane.
inline void level_plane(HeightMap& map) { level_polynomial(map, 1); }

/// Smooths with a Gaussian of standard deviation `sigma_um`, renormalised at the edges (wrapped
/// around on a periodic map). InputError when sigma is not positive or exceeds half the map.
void filter_gaussian(HeightMap& map, double sigma_um);

/// Replaces each height by the median of the (2 radius + 1)^2 pixels around it, fewer at the edges
/// (wrapped around on a periodic map). InputError when radius is not in [1, 50].
void filter_median(HeightMap& map, int radius);

/// Removes the tip's oscillation along each line of x by local linear regression with tricube
/// weights over a full width `width_um` (W. S. Cleveland 1979, J. Am. Stat. Assoc. 74, 829, without
/// the robustness iterations). InputError when the window holds fewer than 3 points or is wider
/// than a line.
void filter_loess_lines(HeightMap& map, double width_um);

}  // namespace scintray
