#include "scintray/surface/unified.hpp"

#include "scintray/core/sampling.hpp"

namespace scintray {

namespace {

/// Facet angle to the mean normal, below 90 deg.
double sample_facet_angle(const UnifiedSurface& surface, Rng& rng) {
  const double sigma = surface.sigma_alpha_rad;
  for (;;) {
    if (surface.definition == SigmaAlphaDefinition::polar_angle) {
      const double alpha = std::abs(sigma * sample_normal(rng));
      if (alpha < 0.5 * kPi) return alpha;
      continue;
    }
    // g(alpha) sin(alpha) from the Rayleigh density g(alpha) alpha by accepting sin(alpha)/alpha.
    const double alpha = sigma * std::sqrt(2.0 * sample_exponential(rng));
    if (alpha < 0.5 * kPi && rng.uniform() * alpha <= std::sin(alpha)) return alpha;
  }
}

/// Facet normal, within 90 deg of `normal`, that faces a ray of direction k.
Vec3 sample_facet(const UnifiedSurface& surface, const Vec3& k, const Vec3& normal, const Frame& frame, Rng& rng) {
  if (surface.sigma_alpha_rad == 0.0) return normal;
  for (;;) {
    const double alpha = sample_facet_angle(surface, rng);
    const double azimuth = kTwoPi * rng.uniform();
    const double sine = std::sin(alpha);
    const Vec3 m = sine * std::cos(azimuth) * frame.x + sine * std::sin(azimuth) * frame.y + std::cos(alpha) * normal;
    const double facing = -k.dot(m);
    if (facing <= 0.0) continue;
    // Seen area of a facet per mean-plane area is facing / cos(alpha).
    if (surface.sampling == FacetSampling::projected_area && rng.uniform() * 1.0 > facing) continue;
    return m;
  }
}

enum class Lobe { spike, facet, backscatter, lambertian };

Lobe sample_lobe(const UnifiedSurface& surface, Rng& rng) {
  if (surface.lobe == 1.0) return Lobe::facet;
  const double u = rng.uniform();
  if (u < surface.spike) return Lobe::spike;
  if (u < surface.spike + surface.lobe) return Lobe::facet;
  if (u < surface.spike + surface.lobe + surface.backscatter) return Lobe::backscatter;
  return Lobe::lambertian;
}

}  // namespace

}  // namespace scintray
