#pragma once
/// Reflection and refraction at a smooth facet between two lossless dielectrics, over a number type
/// (core/number.hpp).
///
/// Formulae: M. Born and E. Wolf, Principles of Optics, 7th ed., section 1.5.2, eqs. (20), (21).

#include "scintray/core/number.hpp"

namespace scintray::optics {

using core::root;
using core::select;

/// Snell's law at an incidence-angle cosine in [0,1], from index n1 to index n2.
template <typename Real>
struct RefractionOf {
  Real ratio;   ///< n1 / n2
  Real sin2_i;  ///< sine squared of the angle of incidence
  Real sin2_t;  ///< ... and of refraction; 1 or more: total reflection

  RefractionOf(Real cos_i, Real n1, Real n2)
      : ratio(n1 / n2), sin2_i(Real(1.0) - cos_i * cos_i), sin2_t(ratio * ratio * sin2_i) {}
  core::MaskOf<Real> total() const { return sin2_t >= Real(1.0); }
  Real cos_t() const { return root(Real(1.0) - sin2_t); }
};

/// Amplitudes of the electric field, below the critical angle, all times one positive factor: without a
/// division.
template <typename Real>
struct FresnelFieldsOf {
  Real incident;
  Real s;  ///< reflected, across the plane of incidence
  Real p;  ///< reflected, in the plane of incidence

  /// @param cos_i  cosine of the angle of incidence, in index n1; @param cos_t of the angle of refraction, in
  ///               index n2
  FresnelFieldsOf(Real cos_i, Real cos_t, Real n1, Real n2) {
    // s = (i1 - t2) / (i1 + t2), p = (i2 - t1) / (i2 + t1), times both denominators.
    const Real i1 = n1 * cos_i, t1 = n1 * cos_t, i2 = n2 * cos_i, t2 = n2 * cos_t;
    const Real of_s = i1 + t2, of_p = i2 + t1;
    incident = of_s * of_p;
    s = (i1 - t2) * of_p;
    p = (i2 - t1) * of_s;
  }
};

/// Amplitudes of the reflected electric field relative to the incident field, below the critical angle.
template <typename Real>
struct FresnelAmplitudesOf {
  Real s;  ///< electric field across the plane of incidence
  Real p;  ///< electric field in the plane of incidence

  /// As of FresnelFieldsOf.
  FresnelAmplitudesOf(Real cos_i, Real cos_t, Real n1, Real n2) {
    const FresnelFieldsOf<Real> fields(cos_i, cos_t, n1, n2);
    const Real inverse = Real(1.0) / fields.incident;
    s = fields.s * inverse;
    p = fields.p * inverse;
  }
};

/// Sine squared of the angle of incidence below which the plane of incidence is numerically undefined.
inline constexpr double kNormalIncidence = 1e-20;

/// Direction and linear polarisation of light, unit vectors; zero polarisation: unpolarised.
template <typename Real>
struct LightRay {
  core::Triple<Real> direction, polarisation;

  friend LightRay select(const core::MaskOf<Real>& condition, const LightRay& yes, const LightRay& no) {
    return {select(condition, yes.direction, no.direction),
            select(condition, yes.polarisation, no.polarisation)};
  }
};

/// Light after specular reflection at a facet with unit normal m. The polarisation component along the normal
/// is kept and the others change sign, as at a perfect conductor (r_s = -1, r_p = 1 in the convention of
/// FresnelAmplitudesOf). Total reflection is treated alike: one linear polarisation vector cannot carry its
/// phase lag between s and p.
template <typename Real>
LightRay<Real> reflected(const LightRay<Real>& light, const core::Triple<Real>& m) {
  return {core::mirrored(light.direction, m), -core::mirrored(light.polarisation, m)};
}

/// The same where a condition holds, and the light as it is elsewhere. Of numbers in lanes alone.
template <typename Real>
LightRay<Real> reflected_where(const core::MaskOf<Real>& condition, const LightRay<Real>& light,
                               const core::Triple<Real>& m) {
  const auto mirrored = [&](const core::Triple<Real>& v) {
    return core::mirrored(v, m, where(condition, dot(v, m)));
  };
  const core::Triple<Real> polarisation = mirrored(light.polarisation);
  const core::BitsOf<Real> sign = bits_of(where(condition, Real(-0.0)));
  const auto opposite = [&sign](const Real& x) { return number_of(bits_of(x) ^ sign); };
  return {mirrored(light.direction),
          {opposite(polarisation.x), opposite(polarisation.y), opposite(polarisation.z)}};
}

/// Cosine of incidence of light at a facet with normal m against it.
template <typename Real>
Real cos_incidence(const LightRay<Real>& light, const core::Triple<Real>& m) {
  const Real cosine = -dot(light.direction, m);
  return core::least(core::greatest(cosine, Real(0.0)), Real(1.0));
}

/// Light at a smooth facet, below the critical angle: whether it is transmitted, and the light that leaves
/// it. Uniform random numbers are compared with reflectances as products, and a common factor of fields
/// cancels where they are normalised, so that neither takes a division.
template <typename Real>
class FacetLight {
  using Vector = core::Triple<Real>;
  using Mask = core::MaskOf<Real>;

 public:
  /// @param m   unit normal opposed to the light; @param cos_i cosine of incidence
  /// @param n1  index of the medium of incidence; @param n2 index behind the facet
  FacetLight(const LightRay<Real>& light, const Vector& m, Real cos_i, const RefractionOf<Real>& at, Real n1,
             Real n2)
      : light_(light),
        m_(m),
        cos_i_(cos_i),
        cos_t_(at.cos_t()),
        ratio_(at.ratio),
        fields_(cos_i, cos_t_, n1, n2) {}

  /// Whether light is transmitted rather than reflected, by a uniform random number in [0, 1): light at
  /// normal incidence, unpolarised light, and light with a polarisation and a plane of incidence, for which
  /// it has to be called before polarised().
  Mask transmits_straight(const Real& uniform) const {
    return uniform * (fields_.incident * fields_.incident) >= fields_.s * fields_.s;
  }
  Mask transmits_unpolarised(const Real& uniform) const {
    return uniform * (Real(2.0) * fields_.incident * fields_.incident) >=
           fields_.s * fields_.s + fields_.p * fields_.p;
  }
  Mask transmits_polarised(const Real& uniform) {
    // Of the length of the sine of incidence, which cancels here and in polarised().
    across_ = cross(light_.direction, m_);
    e_s_ = dot(light_.polarisation, across_);
    e_p_ = dot(light_.polarisation, cross(across_, light_.direction));
    const Real s = fields_.s * e_s_, p = fields_.p * e_p_;
    return uniform * (fields_.incident * fields_.incident * (e_s_ * e_s_ + e_p_ * e_p_)) >= s * s + p * p;
  }

  Vector refracted() const {
    return rounded_to_unit(ratio_ * light_.direction + (ratio_ * cos_i_ - cos_t_) * m_);
  }
  Vector mirrored() const { return core::mirrored(light_.direction, m_); }
  /// Polarisation after transmission or reflection into a direction.
  Vector polarised(const Mask& transmitted, const Vector& into) const {
    // t_p = (n1/n2)(1 + r_p), same convention. p is s x k on every side, so r_p's sign convention (Born &
    // Wolf fig. 1.10) carries over.
    const Real out_s = select(transmitted, fields_.incident + fields_.s, fields_.s) * e_s_;
    const Real out_p = select(transmitted, ratio_ * (fields_.incident + fields_.p), fields_.p) * e_p_;
    return normalised(out_s * across_ + out_p * cross(across_, into));
  }

 private:
  const LightRay<Real>& light_;
  const Vector& m_;
  Real cos_i_, cos_t_, ratio_;
  FresnelFieldsOf<Real> fields_;
  Vector across_{Real(0.0), Real(0.0), Real(0.0)};
  Real e_s_{0.0}, e_p_{0.0};
};

}  // namespace scintray::optics
