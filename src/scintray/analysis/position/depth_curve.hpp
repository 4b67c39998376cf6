#pragma once
/// Light output, or another quantity, against depth.

#include <cstddef>
#include <span>
#include <vector>

#include "scintray/core/statistics.hpp"

namespace scintray::analysis {

/// y = offset + slope x.
struct StraightLine {
  core::Estimate offset, slope;
  double covariance = 0.0;  ///< of offset and slope
  core::ChiSquare goodness;
  core::Estimate at(double x) const;
};

/// Least squares with weights 1 / error^2, by GSL. @throws std::invalid_argument with fewer than two
/// different x, when the sizes differ, or for an error that is not positive.
StraightLine fit_line(std::span<const double> x, std::span<const core::Estimate> y);

struct DepthPoint {
  double depth_mm = 0.0;
  std::size_t count = 0;  ///< events
  core::Estimate value;
  bool from_peak = false;  ///< the value is a photopeak's position; else a mean
};

struct DepthCurve {
  std::vector<DepthPoint> points;        ///< by depth
  std::size_t reference = 0;             ///< index of the point that others are divided by
  std::vector<core::Estimate> relative;  ///< value over that of the reference; exactly 1 for the reference
  StraightLine line;                     ///< of value against depth; zeros with fewer than two points
  /// Slope over the line's value in the middle of the depths, 1/mm: the relative change per mm.
  core::Estimate relative_slope_per_mm;
};

/// Depth curve of points in order of depth. @param reference_mm  the point nearest to it is the reference
/// @throws std::invalid_argument without points, or for a value or an error that is not positive
DepthCurve depth_curve(std::vector<DepthPoint> points, double reference_mm);

/// Points of a depth curve, one per slice of equal thickness between the least and the greatest depth: the
/// photopeak's position where a fit locates it in every slice, the mean in all of them otherwise (a curve
/// never mixes the two). Slices with fewer than `least` values are left out; the depth of a slice is the mean
/// depth of its events.
std::vector<DepthPoint> depth_points(std::span<const double> depths_mm, std::span<const double> values,
                                     std::size_t slices, std::size_t least = 20);

}  // namespace scintray::analysis
