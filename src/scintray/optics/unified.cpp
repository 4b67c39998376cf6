#include "scintray/optics/unified.hpp"

#include <algorithm>

#include "scintray/core/sampling.hpp"

namespace scintray::optics {

namespace {

/// Facet angle to the mean normal, below 90 deg.
double sample_facet_angle(const UnifiedSurface& surface, core::Rng& rng) {
  const double sigma = surface.sigma_alpha_rad;
  for (;;) {
    if (surface.definition == SigmaAlphaDefinition::polar_angle) {
      const double alpha = std::abs(sigma * core::sample_normal(rng));
      if (alpha < 0.5 * core::kPi) return alpha;
      continue;
    }
    // g(alpha) sin(alpha) from the Rayleigh density g(alpha) alpha by accepting sin(alpha)/alpha.
    const double alpha = sigma * std::sqrt(2.0 * core::sample_exponential(rng));
    if (alpha < 0.5 * core::kPi && rng.uniform() * alpha <= std::sin(alpha)) return alpha;
  }
}

/// Facet angles beyond this many sigma (one in 7e7 of the solid-angle density) are drawn again, which
/// bounds the area that a facet can show.
constexpr double kWidestFacet_sigma = 6.0;

/// Largest cosine between the reversed direction of a ray and any facet normal.
double greatest_facing(const UnifiedSurface& surface, double cos_incidence) {
  const double widest = kWidestFacet_sigma * surface.sigma_alpha_rad;
  const double incidence = std::acos(std::clamp(cos_incidence, 0.0, 1.0));
  return incidence <= widest ? 1.0 : std::cos(incidence - widest);
}

/// Facet normal, within 90 deg of `frame.z`, that faces a ray of direction k.
core::Vec3 sample_facet(const UnifiedSurface& surface, const core::Vec3& k, const core::Frame& frame,
                        core::Rng& rng) {
  if (surface.sigma_alpha_rad == 0.0) return frame.z;
  const bool weighted = surface.sampling == FacetSampling::projected_area;
  const double bound = weighted ? greatest_facing(surface, -k.dot(frame.z)) : 1.0;
  for (;;) {
    const double alpha = sample_facet_angle(surface, rng);
    if (weighted && alpha > kWidestFacet_sigma * surface.sigma_alpha_rad) continue;
    const double azimuth = core::kTwoPi * rng.uniform();
    const double sine = std::sin(alpha);
    const core::Vec3 m =
        sine * std::cos(azimuth) * frame.x + sine * std::sin(azimuth) * frame.y + std::cos(alpha) * frame.z;
    const double facing = -k.dot(m);
    if (facing <= 0.0) continue;
    if (weighted && rng.uniform() * bound > facing) continue;
    return m;
  }
}

enum class Lobe { spike, facet, backscatter, lambertian };

Lobe sample_lobe(const UnifiedSurface& surface, core::Rng& rng) {
  if (surface.lobe == 1.0) return Lobe::facet;
  const double u = rng.uniform();
  if (u < surface.spike) return Lobe::spike;
  if (u < surface.spike + surface.lobe) return Lobe::facet;
  if (u < surface.spike + surface.lobe + surface.backscatter) return Lobe::backscatter;
  return Lobe::lambertian;
}

/// Replaces a mirror reflection at a facet by the chosen lobe. `before` is the ray as it came.
void apply_lobe(Lobe lobe, Ray& ray, const Ray& before, const core::Vec3& against, core::Rng& rng) {
  switch (lobe) {
    case Lobe::facet:
      return;
    case Lobe::spike:
      ray = before;
      reflect(ray, against);
      return;
    case Lobe::backscatter:
      ray = {-before.direction, before.polarisation};
      return;
    case Lobe::lambertian:
      ray.direction = core::sample_lambertian(against, rng);
      if (!before.polarisation.isZero(0.0)) ray.polarisation = core::sample_polarisation(ray.direction, rng);
      return;
  }
}

}  // namespace

Side UnifiedSurface::scatter(Ray& ray, Side side, const core::Vec3& normal, const IndexPair& index,
                             core::Rng& rng) const {
  for (;;) {
    const core::Vec3 against = side == Side::inside ? core::Vec3(-normal) : normal;
    const core::Vec3 facet = sample_facet(*this, ray.direction, core::Frame::about(against), rng);
    const Ray before = ray;
    if (interact_at_facet(ray, facet, index.on(side), index.on(other(side)), rng))
      side = other(side);
    else
      apply_lobe(sample_lobe(*this, rng), ray, before, against, rng);
    const double outward = ray.direction.dot(normal);
    if (side == Side::inside ? outward < 0.0 : outward > 0.0) return side;
  }
}

}  // namespace scintray::optics
