#pragma once
/// Fit of a recipe to given visible slopes.

#include "scintray/topography/synthesis.hpp"

namespace scintray::topography {

/// Targets of a recipe on average over `realisations` maps, of the seeds from the recipe's own
/// upwards. Slopes are visible from inside, rad, traced with 40,000 rays a map.
struct SlopeTarget {
  double normal_rad = 0.0;
  double grazing_rad = 0.0;    ///< at kGrazingStated_rad, 88.5 deg; 0: free
  double rms_height_um = 0.0;  ///< Sq; 0: free
  std::uint32_t realisations = 1;
};

/// The recipe with given visible slopes. Varies the rise of the fracture (of a recipe without one: the height
/// of the Gaussian relief) for the slope at normal incidence, starting from the recipe's own; when they are
/// targets, together with the exponent of the fracture for the slope at grazing incidence and the height of
/// the Gaussian relief beside the fracture for the rms height. M. J. D. Powell's hybrid method (MINPACK
/// hybrd, J. J. More, B. S. Garbow and K. E. Hillstrom 1980, ANL-80-74, as Eigen has it), in
/// logarithms, which make the problem nearly linear. InputError when the recipe has no part for a
/// target, or when a slope is missed by more than 2 % or the height by more than 2 %.
SynthesisRecipe fit_recipe(const SynthesisRecipe& recipe, const SlopeTarget& target);

}  // namespace scintray::topography
