#pragma once
/// Preparation of a raw height map: cropping, levelling and filters. Each adds a line to the map's steps.
/// Missing points (NaN) are left out and remain missing.

#include <cstdint>

#include "scintray/topography/height_map.hpp"

namespace scintray::topography {

/// A rectangle of points of a map, counted from 0.
struct CropBox {
  std::uint32_t column = 0, row = 0;  ///< the first
  std::uint32_t columns = 0, rows = 0;
  bool operator==(const CropBox&) const = default;
};

/// Keeps the points of the box. The result of cropping a periodic map is not periodic. InputError when the
/// box extends beyond the map or has fewer than 2 x 2 points.
void crop(HeightMap& map, const CropBox& box);

/// The box of this corner and size, um, rounded to whole points. InputError when one is negative.
CropBox crop_box_um(const HeightMap& map, double x_um, double y_um, double width_um, double height_um);

/// Subtracts the mean height. InputError when every point is missing.
void subtract_mean(HeightMap& map);

/// Subtracts the least-squares polynomial of total degree `degree` (1: a plane) in x and y.
/// InputError when degree is not in [0, 8], or when the points with a height are fewer than the
/// coefficients or do not determine them.
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
/// weights (1 - |2 x / width|^3)^3 over a full width `width_um` (W. S. Cleveland 1979, J. Am. Stat.
/// Assoc. 74, 829, with a window of constant width instead of a constant number of points and
/// without the robustness iterations). InputError when the window holds fewer than 3 points or is
/// wider than a line.
void filter_loess_lines(HeightMap& map, double width_um);

}  // namespace scintray::topography
