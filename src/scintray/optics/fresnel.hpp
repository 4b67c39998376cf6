#pragma once
/// Reflection and refraction of a photon at a smooth facet between two lossless dielectrics: the laws of
/// fresnel_laws.hpp, and of birefringent_faces.cpp where one of them is birefringent.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "scintray/core/plain_vec.hpp"
#include "scintray/core/rng.hpp"
#include "scintray/core/sampling.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/optics/fresnel_laws.hpp"

namespace scintray::optics {

struct BirefringentOptics;

using Refraction = RefractionOf<double>;
using FresnelAmplitudes = FresnelAmplitudesOf<double>;

/// Power reflectances of the two polarisations, and the angle of refraction.
struct FresnelCoefficients {
  double reflectance_s = 1.0;  ///< electric field across the plane of incidence
  double reflectance_p = 1.0;  ///< electric field in the plane of incidence
  double cos_refracted = 0.0;  ///< 0 under total reflection

  double unpolarised() const { return 0.5 * (reflectance_s + reflectance_p); }
};

/// Fresnel coefficients for light incident in index n1 on index n2, at incidence-angle cosine cos_i in [0,1].
inline FresnelCoefficients fresnel(double cos_i, double n1, double n2) {
  const Refraction refraction(cos_i, n1, n2);
  if (refraction.total()) return {};
  const double cos_t = refraction.cos_t();
  const FresnelAmplitudes r(cos_i, cos_t, n1, n2);
  return {r.s * r.s, r.p * r.p, cos_t};
}

/// A travelling photon's direction and linear polarisation. A zero polarisation vector means
/// unpolarised light: Fresnel then uses the mean of the two reflectances. A ray that keeps phases is
/// polarised elliptically (optics/elliptical.hpp); its polarisation is then the major axis.
struct Ray {
  core::PlainVec3 direction;
  core::PlainVec3 polarisation;
  double ellipticity_rad = 0.0;  ///< 0: linear; used where phases are kept
  bool keeps_phases = false;     ///< between the two polarisations, at every interaction
};
static_assert(std::is_trivially_copyable_v<Ray>);

/// Specular reflection at a facet with unit normal `m` (either orientation). The polarisation component along
/// the normal is kept and the others change sign, as at a perfect conductor (r_s = -1, r_p = 1 in the
/// convention of FresnelAmplitudesOf). Total reflection is treated alike: one linear polarisation vector
/// cannot carry its phase lag between s and p.
inline void reflect(Ray& ray, const core::Vec3& m) {
  ray.direction = core::mirror(ray.direction, m);
  ray.polarisation = -core::mirror(ray.polarisation, m);
  ray.ellipticity_rad = -ray.ellipticity_rad;  // the field turns as before, the direction does not
}

/// A linear polarisation drawn uniformly in the plane perpendicular to the direction.
inline void repolarise(Ray& ray, core::Rng& rng) {
  ray.polarisation = core::sample_polarisation(ray.direction, rng);
  ray.ellipticity_rad = 0.0;
}

/// Isotropic scattering: a new direction and, for a polarised ray, a new polarisation drawn across it.
inline void scatter_isotropic(Ray& ray, core::Rng& rng) {
  const bool polarised = !ray.polarisation.isZero(0.0);
  ray.direction = core::sample_isotropic(rng);
  if (polarised) repolarise(ray, rng);
}

/// Lambertian scattering to the side of the unit normal: the direction is new and, for a polarised ray, the
/// polarisation is drawn across it.
inline void scatter_lambertian(Ray& ray, const core::Vec3& normal, core::Rng& rng) {
  const bool polarised = !ray.polarisation.isZero(0.0);
  ray.direction = core::sample_lambertian(normal, rng);
  if (polarised) repolarise(ray, rng);
}

/// A medium at a face: of one index, or birefringent, where `index` is not used.
struct FaceMedium {
  double index = 1.0;
  const BirefringentOptics* birefringent = nullptr;
};

/// Side of a microsurface on which a photon is.
enum class Side : std::uint8_t { inside = 0, outside = 1 };

constexpr Side other(Side side) { return side == Side::inside ? Side::outside : Side::inside; }

/// Refractive indices on the two sides of a microsurface. Where a medium is birefringent, `inside` or
/// `outside` is the index of the light's mode, or the mean of the medium's for models with a single index.
struct IndexPair {
  double inside = 1.0;
  double outside = 1.0;
  const BirefringentOptics* birefringent_inside = nullptr;
  const BirefringentOptics* birefringent_outside = nullptr;

  double on(Side side) const { return side == Side::inside ? inside : outside; }
  FaceMedium medium_on(Side side) const {
    return {on(side), side == Side::inside ? birefringent_inside : birefringent_outside};
  }
  bool birefringent() const { return birefringent_inside || birefringent_outside; }
};

/// Interaction with a smooth facet: reflects or refracts `ray` with the Fresnel probability of its
/// polarisation and transforms the polarisation accordingly.
///
/// @param m   unit normal opposed to the ray: direction . m <= 0
/// @param n1  index of the medium of incidence; @param n2 index behind the facet
/// @return true when the ray was refracted into n2.
bool interact_at_facet(Ray& ray, const core::Vec3& m, double n1, double n2, core::Rng& rng);

/// As interact_at_facet(ray, m, n1, n2, rng), where at least one of the two media is birefringent: the ray
/// leaves in one of the modes of the reflected or the transmitted light, with the share of each in the power.
/// The fields are matched without approximation, evanescent ones included (birefringent_faces.cpp).
///
/// @param m  unit normal opposed to the ray
/// @return true when the ray was refracted into `behind`
[[gnu::noinline, gnu::cold]] bool interact_at_birefringent(Ray& ray, const core::Vec3& m,
                                                           const FaceMedium& here, const FaceMedium& behind,
                                                           core::Rng& rng);

/// Interaction at a smooth facet of a microsurface of a ray on one side of it. Arguments and result as for
/// interact_at_facet(ray, m, n1, n2, rng), which this is between two media of one index.
inline bool interact_at_facet(Ray& ray, const core::Vec3& m, const IndexPair& index, Side side,
                              core::Rng& rng) {
  if (index.birefringent()) [[unlikely]]
    return interact_at_birefringent(ray, m, index.medium_on(side), index.medium_on(other(side)), rng);
  return interact_at_facet(ray, m, index.on(side), index.on(other(side)), rng);
}

/// Refraction of `ray` by Snell's law without any reflection, as of light transmitted by a thin film between
/// indices n1 and n2; the shares of the two polarisations are kept. Beyond the critical angle the ray is
/// reflected instead. Arguments and result as for interact_at_facet.
bool refract_only(Ray& ray, const core::Vec3& m, double n1, double n2);

}  // namespace scintray::optics
