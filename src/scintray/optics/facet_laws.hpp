#pragma once
/// Facets whose angles are normally distributed, over a number type (core/number.hpp): of one photon, which
/// FacetSurface::sample_facet (facets.hpp) draws number by number, and of several in lanes, with the same
/// random numbers, results and bits. Sources: facets.hpp.

#include "scintray/core/elementary_laws.hpp"
#include "scintray/core/xoroshiro.hpp"

namespace scintray::optics {

using core::root;
using core::select;

inline constexpr double kQuarterTurn_rad = 1.57079632679489661923;

/// Facets weighted by area beyond this many sigma (one in 7e7 of the solid-angle density) are drawn again,
/// which bounds the projected area of a facet.
inline constexpr double kWidestFacet_sigma = 6.0;

/// Angle between facet and mean normal from a number uniform on (0, 1], of density g(angle) angle; an angle
/// below a quarter turn is accepted with probability sin(angle) / angle, for g(angle) sin(angle).
template <typename Real>
Real facet_angle(const Real& sigma_rad, const Real& random) {
  return sigma_rad * root(Real(-2.0) * core::laws::log<Real>(random));
}

/// Normal of a facet of a tilt at an azimuth about the mean normal.
template <typename Real>
core::Triple<Real> facet_normal(const core::SineCosineOf<Real>& tilt, const core::SineCosineOf<Real>& azimuth,
                                const core::Across<Real>& across, const core::Triple<Real>& mean) {
  return (tilt.sine * azimuth.cosine) * across.x + (tilt.sine * azimuth.sine) * across.y + tilt.cosine * mean;
}

/// Largest cosine between the reversed direction of light and any facet normal: that of the incidence angle
/// less the widest facet angle.
template <typename Real>
Real greatest_facing(const Real& cos_incidence, const core::SineCosineOf<Real>& of_widest) {
  const Real c = core::least(core::greatest(cos_incidence, Real(0.0)), Real(1.0));
  const Real widest = c * of_widest.cosine + root(Real(1.0) - c * c) * of_widest.sine;
  return select(c >= of_widest.cosine, Real(1.0), widest);
}

/// Numbers of a surface's facets.
template <typename Real>
struct FacetNumbers {
  Real sigma_rad;
  Real widest_rad;              ///< of facets weighted by area: those beyond are drawn again
  Real sin_widest, cos_widest;  ///< at a quarter turn, 1 and -1: nothing is bounded
  core::MaskOf<Real> by_area;   ///< facets are weighted by their projected area
};

/// The numbers of an attempt to draw a facet, uniform on [0, 1).
template <typename Real>
struct FacetRandom {
  Real tilt;  ///< above 0, to 1
  Real azimuth, acceptance;

  explicit FacetRandom(core::Xoroshiro<core::BitsOf<Real>>& stream)
      : tilt(core::uniform_positive_of<Real>(stream.next())),
        azimuth(core::uniform_of<Real>(stream.next())),
        acceptance(core::uniform_of<Real>(stream.next())) {}
};

/// An attempt to draw a facet: its angle by the Rayleigh density g(alpha) alpha, of which g(alpha) sin(alpha)
/// accepts sin(alpha) / alpha, and the share of its projected area.
template <typename Real>
struct FacetDraw {
  core::Triple<Real> normal;
  core::MaskOf<Real> accepted;

  /// @param k  direction of the light; @param mean  mean normal, against it
  FacetDraw(const FacetNumbers<Real>& of, const core::Triple<Real>& k, const core::Triple<Real>& mean,
            const FacetRandom<Real>& random) {
    const Real angle = facet_angle<Real>(of.sigma_rad, random.tilt);
    const core::SineCosineOf<Real> tilt = core::laws::sincos<Real>(angle);
    const core::SineCosineOf<Real> azimuth = core::laws::sincos_of_turn<Real>(random.azimuth);
    normal = facet_normal<Real>(tilt, azimuth, core::Across<Real>(mean), mean);
    const Real facing = -dot(k, normal);
    const core::MaskOf<Real> possible =
        (angle < Real(kQuarterTurn_rad)) & (facing > Real(0.0)) & !(of.by_area & (angle > of.widest_rad));
    const Real one(1.0), bound = greatest_facing<Real>(-dot(k, mean), {of.sin_widest, of.cos_widest});
    const Real weight = tilt.sine * select(of.by_area, facing, one);
    accepted = possible & (random.acceptance * (angle * select(of.by_area, bound, one)) <= weight);
  }
};

/// Numbers of a surface's facets that do not depend on the light.
struct FacetLimits {
  bool by_area;
  double widest_rad;
  core::SineCosineOf<double> of_widest{1.0, -1.0};

  FacetLimits(double sigma_rad, bool weighted)
      : by_area(weighted), widest_rad(kWidestFacet_sigma * sigma_rad) {
    if (by_area && widest_rad < kQuarterTurn_rad) of_widest = core::laws::sincos(widest_rad);
  }
};

}  // namespace scintray::optics
