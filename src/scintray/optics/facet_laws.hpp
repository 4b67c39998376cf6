#pragma once
/// Facets of a normal distribution of angles to the mean normal, over a number type (core/number.hpp).
///
/// Source: A. Levin and C. Moisan 1996, "A more physical approach to model the surface treatment of
/// scintillation counters and its implementation into DETECT", IEEE NSS.

#include "scintray/core/elementary_laws.hpp"

namespace scintray::optics {

using core::root;
using core::select;

/// Facet angles beyond this many sigma (one in 7e7 of the solid-angle density) are drawn again where facets
/// are weighted by the area that the light sees, which bounds that area.
inline constexpr double kWidestFacet_sigma = 6.0;

/// Sine and cosine of the widest facet angle, below a quarter turn, for facets weighted by projected area.
template <typename Real>
struct WidestFacet {
  Real sine, cosine;

  /// Half of the largest projected area of a facet and its mirror image in the mean normal together, for
  /// light of the given cosine of incidence: the cosine itself where the light sees both, else half of the
  /// cosine of the incidence less the widest angle.
  Real greatest_area(const Real& cos_incidence) const {
    const Real c = core::least(core::greatest(cos_incidence, Real(0.0)), Real(1.0));
    const Real widest = c * cosine + root(Real(1.0) - c * c) * sine;
    return core::greatest(c, Real(0.5) * select(c >= cosine, Real(1.0), widest));
  }
};

/// A facet at a random angle, with the weight with which it has to be accepted: of angles alpha drawn by
/// exp(-alpha^2 / 2 sigma^2) alpha, the share sin(alpha) / alpha, so that facets per solid angle follow the
/// normal distribution.
template <typename Real>
struct FacetTilt {
  Real angle_rad;
  core::SineCosineOf<Real> of;  ///< its sine and cosine
  Real weight, most;            ///< accepted in weight / most of the cases

  static FacetTilt drawn(const Real& sigma_rad, const Real& uniform_positive) {
    const Real angle = sigma_rad * root(Real(-2.0) * core::laws::log<Real>(uniform_positive));
    const core::SineCosineOf<Real> of = core::laws::sincos<Real>(angle);
    return {angle, of, of.sine, angle};
  }
};

/// Choice between a facet at a random azimuth, its mirror image in the mean normal, and neither, by the area
/// of each that the light sees, or by whether it sees it.
template <typename Real>
struct FacetChoice {
  core::Triple<Real> normal;
  core::MaskOf<Real> accepted;

  /// @param k       direction of the light
  /// @param mean    mean normal, against the light; @param across its frame
  /// @param area    WidestFacet::greatest_area, for facets weighted by projected area
  /// @param by_area whether they are
  /// @param random  azimuth and choice
  FacetChoice(const core::Triple<Real>& k, const core::Triple<Real>& mean, const core::Across<Real>& across,
              const FacetTilt<Real>& tilt, const core::MaskOf<Real>& by_area, const Real& area,
              const core::TwoUniforms<Real>& random) {
    const Real zero(0.0), one(1.0);
    const core::SineCosineOf<Real> azimuth = core::laws::sincos_of_turn<Real>(random.first);
    const core::Triple<Real> lateral =
        (tilt.of.sine * azimuth.cosine) * across.x + (tilt.of.sine * azimuth.sine) * across.y;
    const core::Triple<Real> along = tilt.of.cosine * mean;
    const Real high = -dot(k, along), wide = dot(k, lateral);
    const Real facing = high - wide, mirrored = high + wide;
    const auto weight = [&](const Real& cosine) {
      return select(cosine > zero, select(by_area, cosine, one), zero);
    };
    const Real scale = select(by_area, area, one);
    const Real drawn = random.second * (Real(2.0) * scale * tilt.most);
    const Real first = tilt.weight * weight(facing), both = first + tilt.weight * weight(mirrored);
    accepted = drawn < both;
    normal = select(drawn < first, along + lateral, along - lateral);
  }
};

}  // namespace scintray::optics
