#pragma once
/// Synthetic height maps, for surfaces that were not measured, and their fit to measured slopes.

#include <cstdint>
#include <string>
#include <vector>

#include "scintray/topography/height_map.hpp"

namespace scintray::topography {

/// A Gaussian random surface, with the autocorrelation exp(-(u / lay_length)^2 - (v /
/// correlation_length)^2), u along the lay (the direction of grooves) and v across it.
struct GaussianRelief {
  double rms_height_um = 0.0;          ///< Sq, exactly
  double correlation_length_um = 1.0;  ///< lag at which the autocorrelation has fallen to 1/e, across the lay
  double lay_length_um = 0.0;          ///< the same along the lay; 0: isotropic
  double lay_angle_rad = 0.0;          ///< of the lay, from x towards y
};

/// Fracture by grit: bowls chipped out of the surface, side by side, each
/// depth + (r / radius)^exponent * rise; the surface is the lowest bowl everywhere, so neighbours
/// join in sharp ridges that are the steepest part. A second, independent set is laid upside down
/// on top, so that grooves are as sharp as ridges and light from both sides hits the same slopes.
struct FractureRelief {
  double spacing_um = 0.0;       ///< mean distance of bowls, 1/sqrt(density); 0: no fracture
  double rise_um = 0.0;          ///< height of a bowl at a distance of spacing / 2
  double exponent = 2.0;         ///< 2: paraboloids; larger: flat floors, steep rims
  double depth_spread_um = 0.0;  ///< depths are uniformly distributed within +- this
  double size_spread = 0.0;      ///< relative radii are uniformly distributed within 1 +- this, in [0, 1)
};

/// Straight scratches left by polishing: grooves of the profile -depth exp(-(distance / width)^2)
/// at random places, in random directions, with depths uniform between 0 and `depth_um`.
struct ScratchRelief {
  double spacing_um = 0.0;  ///< area of the map over the total length of scratches; 0: none
  double length_um = 30.0;  ///< below half the map's width
  double depth_um = 0.0;
  double width_um = 0.5;  ///< half the width at 1/e of the depth
};

/// A Gaussian random surface with the K-correlation ("ABC") power spectrum, flat at low spatial
/// frequencies and a power law at high ones: S(f) = A' / (1 + (B f)^2)^((C + 1) / 2), with
/// A' = Sq^2 B^2 (C - 1) / (2 pi) (E. L. Church, P. Z. Takacs and T. A. Leonard 1989, Proc. SPIE
/// 1165, 136, two-dimensional form; A' follows from the integral of 2 pi f S over all f being Sq^2).
/// A map contains the part of Sq between its width and its pitch.
struct KCorrelationRelief {
  double rms_height_um = 0.0;   ///< Sq over all frequencies; 0: none
  double knee_length_um = 1.0;  ///< B: the power law begins at the spatial frequency 1/B
  double exponent = 3.0;        ///< C > 1: profiles fall as f^-C, the two-dimensional spectrum as f^-(C+1)
};

/// A Gaussian random surface with a tabulated two-dimensional, isotropic power spectral density
/// S(f): the integral of 2 pi f S(f) over the spatial frequency f is Sq^2. Between points log S is
/// linear in log f (S in f where a density is zero); outside the table there is no power.
struct SpectrumRelief {
  std::vector<double> frequency_per_um;  ///< positive, strictly increasing; empty: none
  std::vector<double> density_um4;       ///< not negative
};

/// All parameters of a synthetic map. The map is periodic; its height is the sum of the reliefs.
struct SynthesisRecipe {
  std::string name = "gaussian";
  GaussianRelief gaussian;
  FractureRelief fracture;
  ScratchRelief scratches;
  KCorrelationRelief k_correlation;
  SpectrumRelief spectrum;
  std::uint32_t columns = 514;
  std::uint32_t rows = 514;
  double pitch_um = 0.175;  ///< as the atomic force microscope of Roncali and Cherry 2013, section 2.1
  std::uint64_t seed = 1;
};

/// A ground crystal, heavy-tailed in slope: on average over seeds 1 to 5 the mean visible slope is 18 deg
/// at normal incidence and 35 deg at grazing (88.5 deg), heights within about +-3 um (Roncali and
/// Cherry 2013, Phys. Med. Biol. 58, 2185, section 3.1), and Sq is 0.45 um, which is not from that
/// source. Spacing, spreads and correlation length were chosen so that heights remain within those
/// limits, the rest was fitted by
///     scintray map synthesize ground --fit-normal "18 deg" --fit-grazing "35 deg"
///         --fit-rms-height "0.45 um" --seeds 5 -o ground.gsf
SynthesisRecipe ground_recipe();

/// A polished crystal with scratches: on average over seeds 1 to 5 the mean visible slope is 1.25 deg, at
/// any incidence up to 85 deg within 0.02 deg, heights within about +-0.05 um (as above). The
/// scratches are an assumption; the height of the Gaussian relief was fitted with them by
///     scintray map synthesize polished --fit-normal "1.25 deg" --seeds 5 -o polished.gsf
SynthesisRecipe polished_recipe();

/// The map of a recipe, the same for the same recipe. InputError names the parameter that is out of range.
HeightMap synthesize(const SynthesisRecipe& recipe);

/// The recipe in one line, numbers in full; of a tabulated spectrum only its extent.
std::string describe(const SynthesisRecipe& recipe);

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
