#pragma once
/// Fit of a recipe to required visible slopes.

#include "scintray/topography/synthesis.hpp"

namespace scintray::topography {

/// Targets of a recipe, as means over `realisations` maps with consecutive seeds from the recipe's own on.
/// Slopes are mean visible slopes from inside, rad, traced with 40,000 rays per map.
struct SlopeTarget {
  double normal_rad = 0.0;
  double grazing_rad = 0.0;    ///< at kGrazingStated_rad, 88.5 deg; 0: free
  double rms_height_um = 0.0;  ///< Sq; 0: free
  std::uint32_t realisations = 1;
};

/// The recipe with the required mean visible slopes. The rise of the fracture (for a recipe without one, the
/// height of the Gaussian relief) is fitted to the slope at normal incidence, starting from the recipe's own;
/// with further targets, together with the exponent of the fracture for the slope at grazing incidence and
/// the height of the Gaussian relief beside the fracture for the rms height. M. J. D. Powell's hybrid method
/// (MINPACK hybrd, J. J. More, B. S. Garbow and K. E. Hillstrom 1980, ANL-80-74, in Eigen's implementation),
/// in logarithms, in which the problem is nearly linear. InputError when the recipe has no parameter for a
/// target, or when a slope or the height deviates from its target by more than 2 % (chosen).
SynthesisRecipe fit_recipe(const SynthesisRecipe& recipe, const SlopeTarget& target);

}  // namespace scintray::topography
