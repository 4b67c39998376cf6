#pragma once
/// The search for a recipe that shows given slopes.

#include "scintray/topography/synthesis.hpp"

namespace scintray::topography {

/// What a recipe is to show on average over `realisations` maps, of the seeds from the recipe's own
/// upwards. Slopes are visible from inside, rad, traced with 40,000 rays a map.
struct SlopeTarget {
  double normal_rad = 0.0;
  double grazing_rad = 0.0;    ///< at kGrazingStated_rad, 88.5 deg; 0: whatever comes out
  double rms_height_um = 0.0;  ///< Sq; 0: whatever comes out
  std::uint32_t realisations = 1;
};

/// Searches the rise of the fracture (of a recipe without one: the height of the Gaussian relief)
/// for the slope at normal incidence, from where the recipe stands; when they are given, together
/// with the exponent of the fracture for the slope at grazing incidence and the height of the
/// Gaussian relief beside the fracture for the rms height. M. J. D. Powell's hybrid method (MINPACK
/// hybrd, J. J. More, B. S. Garbow and K. E. Hillstrom 1980, ANL-80-74, as Eigen has it), in
/// logarithms, which make the problem nearly linear. InputError when a target is requested that the
/// recipe has no part for, or when a slope is missed by more than 2 % or the height by more than 2 %.
SynthesisRecipe fit_recipe(const SynthesisRecipe& recipe, const SlopeTarget& target);

}  // namespace scintray::topography
