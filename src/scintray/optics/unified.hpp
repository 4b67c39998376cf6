#pragma once
/// The UNIFIED facet model.
///
/// Source: A. Levin and C. Moisan 1996, "A more physical approach to model the surface treatment of
/// scintillation counters and its implementation into DETECT", IEEE NSS; S. K. Nayar et al. 1991,
/// IEEE PAMI 13(7), for the lobes.

#include "scintray/optics/microsurface.hpp"

namespace scintray::optics {

/// What sigma_alpha is the width of. The two differ: for 18 deg the mean facet angle is 22.2 deg
/// by the first and 14.4 deg by the second.
enum class SigmaAlphaDefinition {
  solid_angle,  ///< Geant4: facets per solid angle ~ exp(-alpha^2 / 2 sigma^2), so alpha ~ g sin
  polar_angle,  ///< alpha itself is normal with standard deviation sigma (its absolute value)
};

/// How facets are met.
enum class FacetSampling {
  projected_area,  ///< facets weighted by the area that the incoming light sees
  geant4,          ///< any facet turned towards the light, with equal weight
};

struct UnifiedSurface {
  double sigma_alpha_rad = 0.0;
  SigmaAlphaDefinition definition = SigmaAlphaDefinition::solid_angle;
  FacetSampling sampling = FacetSampling::projected_area;
  // Shares of reflected light; the rest, 1 - spike - lobe - backscatter, is Lambertian.
  double spike = 0.0;
  double lobe = 1.0;
  double backscatter = 0.0;

  /// As every microsurface. A ray whose outcome at a facet still heads into the surface meets
  /// another facet from there (as in Geant4's boundary process).
  Side scatter(Ray& ray, Side side, const core::Vec3& normal, const IndexPair& index, core::Rng& rng) const;
};

}  // namespace scintray::optics
