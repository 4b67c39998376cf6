#pragma once
/// Facets at angles to the mean normal of a surface, and the lobes of what they reflect.
///
/// Sources: A. Levin and C. Moisan 1996, "A more physical approach to model the surface treatment of
/// scintillation counters and its implementation into DETECT", IEEE NSS; S. K. Nayar et al. 1991,
/// IEEE PAMI 13(7), for the facets of sigma_alpha and the lobes. Facets of a smeared normal: GEANT3's surface
/// model as Geant4's boundary process has it (Book For Application Developers, section "Boundary Process").

#include <algorithm>
#include <cmath>

#include "scintray/core/elementary.hpp"
#include "scintray/core/sampling.hpp"
#include "scintray/optics/facet_laws.hpp"
#include "scintray/optics/microsurface.hpp"

namespace scintray::optics {

/// The distribution whose width is sigma_alpha. The two differ: for 18 deg the mean facet angle is 22.2 deg
/// by the first and 14.4 deg by the second.
enum class SigmaAlphaDefinition {
  solid_angle,  ///< Geant4: facets per solid angle ~ exp(-alpha^2 / 2 sigma^2), so alpha ~ g sin
  polar_angle,  ///< alpha itself is normal with standard deviation sigma (its absolute value)
};

/// Probability with which light hits a facet.
enum class FacetSampling {
  projected_area,  ///< facets weighted by their area projected along the incoming light
  geant4,          ///< any facet turned towards the light, with equal weight
};

/// Facets whose angles to the mean normal are normally distributed, or those of a smeared normal. Defined in
/// this header, so that the sampling of facets can be inlined into the loop that scatters many photons.
class FacetSurface : public MicrosurfaceModel {
 public:
  double sigma_alpha_rad = 0.0;
  SigmaAlphaDefinition definition = SigmaAlphaDefinition::solid_angle;
  FacetSampling sampling = FacetSampling::projected_area;
  // Shares of reflected light; the rest, 1 - spike - lobe - backscatter, is Lambertian.
  double spike = 0.0;
  double lobe = 1.0;
  double backscatter = 0.0;
  /// Smeared normal: facet normals are the mean normal plus a point of the ball of this radius, uniform over
  /// its volume (1 less a polish); 0: facets by sigma_alpha.
  double smear = 0.0;

  enum class Lobe { spike, facet, backscatter, lambertian };

  /// The side on which the ray leaves. A ray whose outcome at a facet still heads into the surface hits
  /// another facet from there (as in Geant4's boundary process).
  Side scatter(Ray& ray, Side side, const core::Vec3& normal, const IndexPair& index, core::Rng& rng) const;
  SurfaceOutcome scatter(Ray& ray, Side side, const IndexPair& index,
                         SurfaceInteraction& interaction) const override;
  bool birefringent() const override { return true; }

  /// Normal of a random facet that faces a ray of direction k, within 90 deg of the mean normal; of a smeared
  /// facet also beyond.
  core::Vec3 sample_facet(const core::Vec3& k, const core::Vec3& mean, core::Rng& rng) const;
  Lobe sample_lobe(core::Rng& rng) const;
  /// Replaces a specular reflection at a facet by the chosen lobe. `before` is the incident ray.
  static void apply_lobe(Lobe chosen, Ray& ray, const Ray& before, const core::Vec3& against, core::Rng& rng);

 private:
  core::Vec3 sample_facet_by_polar_angle(const core::Vec3& k, const core::Vec3& mean, core::Rng& rng) const;
  core::Vec3 sample_smeared_facet(const core::Vec3& k, const core::Vec3& mean, core::Rng& rng) const;
};

inline core::Vec3 FacetSurface::sample_facet(const core::Vec3& k, const core::Vec3& mean,
                                             core::Rng& rng) const {
  if (smear > 0.0) [[unlikely]]
    return sample_smeared_facet(k, mean, rng);
  if (sigma_alpha_rad == 0.0) return mean;
  if (definition == SigmaAlphaDefinition::polar_angle) [[unlikely]]
    return sample_facet_by_polar_angle(k, mean, rng);
  const FacetLimits limits(sigma_alpha_rad, sampling == FacetSampling::projected_area);
  const FacetNumbers<double> numbers{sigma_alpha_rad, limits.widest_rad, limits.of_widest.sine,
                                     limits.of_widest.cosine, limits.by_area};
  core::Rng::State stream = rng.state();
  for (;;) {
    const FacetDraw<double> facet(numbers, core::triple(k), core::triple(mean), FacetRandom<double>(stream));
    if (!facet.accepted) continue;
    rng.go_on_from(stream);
    return core::vec(facet.normal);
  }
}

inline core::Vec3 FacetSurface::sample_facet_by_polar_angle(const core::Vec3& k, const core::Vec3& mean,
                                                            core::Rng& rng) const {
  const bool by_area = sampling == FacetSampling::projected_area;
  const core::Across<double> across(core::triple(mean));
  for (;;) {
    const double alpha = std::abs(sigma_alpha_rad * core::sample_normal(rng));
    if (!(alpha < 0.5 * core::kPi)) continue;
    const core::Vec3 m = core::vec(facet_normal<double>(
        core::sincos(alpha), core::sincos_of_turn(rng.uniform()), across, core::triple(mean)));
    const double facing = -k.dot(m);
    if (facing > 0.0 && (!by_area || rng.uniform() <= facing)) return m;
  }
}

inline core::Vec3 FacetSurface::sample_smeared_facet(const core::Vec3& k, const core::Vec3& mean,
                                                     core::Rng& rng) const {
  for (;;) {
    const core::Vec3 point(2.0 * rng.uniform() - 1.0, 2.0 * rng.uniform() - 1.0, 2.0 * rng.uniform() - 1.0);
    if (point.squaredNorm() > 1.0) continue;
    const core::Vec3 sum = mean + smear * point;
    const double length = sum.norm();
    if (length == 0.0) continue;
    const core::Vec3 m = sum / length;
    const double facing = -k.dot(m);
    if (facing <= 0.0) continue;
    if (sampling == FacetSampling::projected_area && rng.uniform() > facing) continue;
    return m;
  }
}

inline FacetSurface::Lobe FacetSurface::sample_lobe(core::Rng& rng) const {
  if (lobe == 1.0) return Lobe::facet;
  const double u = rng.uniform();
  if (u < spike) return Lobe::spike;
  if (u < spike + lobe) return Lobe::facet;
  if (u < spike + lobe + backscatter) return Lobe::backscatter;
  return Lobe::lambertian;
}

inline void FacetSurface::apply_lobe(Lobe chosen, Ray& ray, const Ray& before, const core::Vec3& against,
                                     core::Rng& rng) {
  switch (chosen) {
    case Lobe::facet:
      return;
    case Lobe::spike:
      ray = before;
      reflect(ray, against);
      return;
    case Lobe::backscatter:
      ray = before;
      ray.direction = -before.direction;
      ray.ellipticity_rad = -before.ellipticity_rad;
      return;
    case Lobe::lambertian:
      ray.polarisation = before.polarisation;
      scatter_lambertian(ray, against, rng);
      return;
  }
}

inline Side FacetSurface::scatter(Ray& ray, Side side, const core::Vec3& normal, const IndexPair& index,
                                  core::Rng& rng) const {
  for (;;) {
    const core::Vec3 against = side == Side::inside ? core::Vec3(-normal) : normal;
    const core::Vec3 facet = sample_facet(ray.direction, against, rng);
    const Ray before = ray;
    if (interact_at_facet(ray, facet, index, side, rng))
      side = other(side);
    else
      apply_lobe(sample_lobe(rng), ray, before, against, rng);
    const double outward = ray.direction.dot(normal);
    if (side == Side::inside ? outward < 0.0 : outward > 0.0) return side;
  }
}

inline SurfaceOutcome FacetSurface::scatter(Ray& ray, Side side, const IndexPair& index,
                                            SurfaceInteraction& interaction) const {
  return outcome_on(scatter(ray, side, interaction.normal, index, interaction.rng));
}

}  // namespace scintray::optics
