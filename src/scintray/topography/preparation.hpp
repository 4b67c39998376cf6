#pragma once
/// All steps from a raw height map to the surface, as set in a command or a scene.

#include <optional>
#include <variant>

#include "scintray/topography/prepare.hpp"

namespace scintray::topography {

/// Levelling: the shape subtracted from a map.
struct Leveling {
  enum class Kind { none, mean, plane, polynomial };
  Kind kind = Kind::plane;
  int degree = 1;  ///< of the polynomial
};

/// A rectangle of a map in lengths.
struct CropLengths {
  double x_um = 0.0, y_um = 0.0, width_um = 0.0, height_um = 0.0;
};

/// The steps, in the order in which they are applied.
struct Preparation {
  std::variant<std::monostate, CropBox, CropLengths> crop;
  std::optional<double> outlier_limit;  ///< robust standard deviations, see remove_outliers
  int outlier_radius = 2;               ///< pixels
  bool fill_missing = false;
  std::optional<int> median_radius;      ///< pixels
  std::optional<double> loess_width_um;  ///< of the weighted local regression along each line
  std::optional<double> gaussian_um;     ///< standard deviation
  Leveling leveling;
};

/// Applies the steps that are set. InputError as each of them.
void prepare(HeightMap& map, const Preparation& preparation);

}  // namespace scintray::topography
