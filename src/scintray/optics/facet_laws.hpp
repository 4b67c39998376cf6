#pragma once
/// Facets as FacetSurface::sample_facet (facets.hpp) draws them, over a number type (core/number.hpp): the
/// same random numbers, results and bits.

#include "scintray/core/elementary_laws.hpp"

namespace scintray::optics {

using core::root;
using core::select;

inline constexpr double kQuarterTurn_rad = 1.57079632679489661923;

/// Numbers of a surface's facets.
template <typename Real>
struct FacetNumbers {
  Real sigma_rad;
  Real widest_rad;              ///< of facets weighted by area: those beyond are drawn again
  Real sin_widest, cos_widest;  ///< at a quarter turn, 1 and -1: nothing is bounded
  core::MaskOf<Real> by_area;   ///< facets are weighted by the area that the light sees

  /// Largest cosine between the reversed direction of light and any facet normal.
  Real greatest_facing(const Real& cos_incidence) const {
    const Real c = core::least(core::greatest(cos_incidence, Real(0.0)), Real(1.0));
    const Real widest = c * cos_widest + root(Real(1.0) - c * c) * sin_widest;
    return select(c >= cos_widest, Real(1.0), widest);
  }
};

/// An attempt to draw a facet.
template <typename Real>
struct FacetDraw {
  core::Triple<Real> normal;
  core::MaskOf<Real> accepted;
  Real drawn;  ///< random numbers used

  struct Random {
    Real tilt;  ///< above 0
    Real for_tilt, azimuth, for_area;
  };
  /// @param k  direction of the light; @param mean  mean normal, against it
  FacetDraw(const FacetNumbers<Real>& of, const core::Triple<Real>& k, const core::Triple<Real>& mean,
            const Random& random) {
    const Real angle = of.sigma_rad * root(Real(-2.0) * core::laws::log<Real>(random.tilt));
    const core::SineCosineOf<Real> tilt = core::laws::sincos<Real>(angle);
    const core::SineCosineOf<Real> azimuth = core::laws::sincos_of_turn<Real>(random.azimuth);
    const core::Across<Real> across(mean);
    normal =
        (tilt.sine * azimuth.cosine) * across.x + (tilt.sine * azimuth.sine) * across.y + tilt.cosine * mean;
    const Real facing = -dot(k, normal);
    // In the order of the numbers: each is drawn where those before are accepted.
    const core::MaskOf<Real> below = angle < Real(kQuarterTurn_rad);
    const core::MaskOf<Real> tilted = below & (random.for_tilt * angle <= tilt.sine);
    const core::MaskOf<Real> turned = tilted & !(of.by_area & (angle > of.widest_rad));
    const core::MaskOf<Real> seen = turned & (facing > Real(0.0));
    const Real bound = of.greatest_facing(-dot(k, mean));
    accepted = seen & !(of.by_area & (random.for_area * bound > facing));
    const Real one(1.0), zero(0.0);
    drawn = one + select(below, one, zero) + select(turned, one, zero) + select(seen & of.by_area, one, zero);
  }
};

/// Numbers of a surface's facets that do not depend on the light.
struct FacetLimits {
  bool by_area;
  double widest_rad;
  core::SineCosineOf<double> of_widest{1.0, -1.0};

  FacetLimits(double sigma_rad, bool weighted) : by_area(weighted), widest_rad(kWidest_sigma * sigma_rad) {
    if (widest_rad < kQuarterTurn_rad) of_widest = core::laws::sincos(widest_rad);
  }

 private:
  static constexpr double kWidest_sigma = 6.0;  // of FacetSurface
};

}  // namespace scintray::optics
