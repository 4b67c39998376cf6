#pragma once
/// Depth of interaction from the light at the two ends of a crystal.

#include <cstddef>
#include <span>
#include <vector>

#include "scintray/analysis/position/depth_curve.hpp"
#include "scintray/analysis/spectrum/spread.hpp"

namespace scintray::analysis {

enum class EndRatio {
  share,     ///< A / (A + B)
  logarithm  ///< ln(A / B), linear in depth where light is attenuated exponentially towards both ends
};

/// Ratio of the light at two ends; NaN unless both have light.
double end_ratio(EndRatio kind, double a, double b);

enum class DoiCalibrationKind {
  linear,   ///< one straight line
  monotone  ///< monotone regression of the slice means, joined by lines
};

/// Calibration from ratio to depth.
struct DoiCalibration {
  std::vector<double> ratio, depth_mm;  ///< knots, by rising ratio, at least two

  /// Linear between knots; beyond them the outermost line is extrapolated.
  double depth(double at_ratio) const;
};

/// Calibration from known depths. The regression is of ratio on depth, then inverted, since the ratio is what
/// fluctuates; the opposite regression would bias depths towards the middle (classical against
/// inverse calibration: R. G. Krutchkoff 1967, Technometrics 9, 425). Monotone: isotonic least squares of the
/// slice means by pooling adjacent violators (M. Ayer et al. 1955, Ann. Math. Statist. 26, 641).
/// @throws InputError when the ratio does not change with depth
DoiCalibration calibrate_doi(std::span<const double> depths_mm, std::span<const double> ratios,
                             DoiCalibrationKind kind, std::size_t slices = 20);

struct DoiSlice {
  double depth_mm = 0.0;
  std::size_t count = 0;
  core::Estimate bias_mm;  ///< mean of estimated minus true depth
  core::Estimate fwhm_mm;  ///< 2.355 times the standard deviation
};

struct DoiAnalysis {
  EndRatio ratio = EndRatio::share;
  DoiCalibrationKind kind = DoiCalibrationKind::linear;
  DoiCalibration calibration;
  StraightLine line;             ///< of the slice means of the ratio against depth
  Spread residual;               ///< estimated minus true depth, mm, of all evaluated events
  std::vector<DoiSlice> slices;  ///< the same by depth
};

/// Depth of interaction, calibrated with the even events and evaluated with the odd ones, so that no event is
/// evaluated by a calibration that includes it. Ratios that are not finite are left out. The spread of depths
/// within an event, which a simulation with gammas has, is part of the result. Errors of the residual and its
/// slices include that of the calibration (jackknife over 32 groups of events, core::jackknife_error).
/// @throws InputError with fewer than 100 usable events, or when the ratio does not change with depth
DoiAnalysis analyze_doi(std::span<const double> depths_mm, std::span<const double> ratios, EndRatio ratio,
                        DoiCalibrationKind kind, std::size_t slices = 10);

}  // namespace scintray::analysis
