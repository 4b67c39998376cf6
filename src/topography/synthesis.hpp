#pragma once
/// Height maps made from a recipe: for surfaces that were not measured.

#include <cstdint>
#include <string>

#include "scintray/topography/height_map.hpp"

namespace scintray {

/// A Gaussian random surface, with a Gaussian autocorrelation exp(-r^2 / correlation_length^2).
struct GaussianRelief {
  double rms_height_um = 0.0;          ///< Sq
  double correlation_length_um = 1.0;  ///< where the autocorrelation has fallen to 1/e
};

/// Fracture by grit: bowls chipped out of the surface, side by side, each
/// depth + (r / radius)^exponent * rise; the surface is the lowest bowl everywhere, so neighbours
/// meet in sharp ridges that are the steepest part. A second, independent set is laid upside down
/// on top, so that grooves are as sharp as ridges and light from both sides meets the same slopes.
struct FractureRelief {
  double spacing_um = 0.0;       ///< mean distance of bowls, 1/sqrt(density); 0: no fracture
  double rise_um = 0.0;          ///< height of a bowl at a distance of spacing / 2
  double exponent = 2.0;         ///< 2: paraboloids; larger: flat floors, steep rims
  double depth_spread_um = 0.0;  ///< depths are uniform within +- this
  double size_spread = 0.0;      ///< radii are uniform within 1 +- this, in [0, 1)
};

/// All that it takes to make the same map again. The map is periodic.
struct SynthesisRecipe {
  std::string name = "gaussian";
  GaussianRelief gaussian;
  FractureRelief fracture;
  std::uint32_t columns = 514;
  std::uint32_t rows = 514;
  double pitch_um = 0.175;  ///< as the atomic force microscope of Roncali and Cherry 2013, section 2.1
  std::uint64_t seed = 1;
};

/// A ground crystal, heavy-tailed in slope: the mean slope met is 18 deg at normal incidence and
/// 35 deg at grazing (88.5 deg), heights within +-3 um (Roncali and Cherry 2013, Phys. Med. Biol.
/// 58, 2185, section 3.1). Rise and exponent of the fracture were searched for these slopes, which
/// `scintray table synthesize ground` prints; `--fit-normal` and `--fit-grazing` search again.
SynthesisRecipe ground_recipe();

/// A polished crystal: mean slope met 1.25 deg at any incidence, heights within +-0.05 um (as above).
SynthesisRecipe polished_recipe();

/// Makes the map; the same recipe always gives the same map. InputError names what is out of range.
HeightMap synthesize(const SynthesisRecipe& recipe);

/// Slopes that a recipe is to show, rad, met from inside at normal and at grazing incidence.
struct SlopeTarget {
  double normal_rad = 0.0;
  double grazing_rad = 0.0;  ///< at 88.5 deg; 0: whatever comes out
};

/// Searches the rise of the fracture (of a recipe without one: the height of the Gaussian relief)
/// for the first target and, when the second is given, the exponent for that. Slopes are traced
/// with 40,000 rays. InputError when either is missed by more than 0.5 deg.
SynthesisRecipe fit_recipe(SynthesisRecipe recipe, const SlopeTarget& target);

}  // namespace scintray
