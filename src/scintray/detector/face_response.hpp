#pragma once
/// Efficiency over the face of a sensor.

#include <cstddef>
#include <optional>
#include <vector>

#include "scintray/core/curve.hpp"

namespace scintray::detector {

/// Factors on a uniform grid, bilinear between its points; beyond the grid those of its border.
struct FaceGrid {
  double x_mm = 0.0, y_mm = 0.0;  ///< of the first point
  double pitch_x_mm = 1.0, pitch_y_mm = 1.0;
  std::size_t columns = 0, rows = 0;  ///< along x and y, two at least
  std::vector<double> factor;         ///< rows one after the other

  double at(double x, double y) const;  ///< mm
};

/// Factor on a sensor's efficiency over its face, from the middle of the face.
class FaceResponse {
 public:
  /// @param factor  against the distance from the middle (mm); constant beyond its ends
  static FaceResponse radial(core::Curve factor);
  static FaceResponse grid(FaceGrid factors);

  /// @param x_mm, y_mm  from the middle of the face, along its two axes
  double at(double x_mm, double y_mm) const;
  double least() const;
  double greatest() const;

 private:
  core::Curve radial_;
  std::optional<FaceGrid> grid_;
};

}  // namespace scintray::detector
