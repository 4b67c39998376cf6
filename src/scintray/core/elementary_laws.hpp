#pragma once
/// Logarithm, sine and cosine for light transport, over a number type (number.hpp). Unlike those of a
/// mathematical library, whose bits depend on the processor, they are sums and products in a fixed order: the
/// same bits on every processor, and in every lane of a vector.
///
/// Polynomials: those of fdlibm (Sun Microsystems 1993: e_log.c, k_sin.c, k_cos.c), with errors below 1 ulp
/// where the argument is exact. Compile without contraction of products and sums (-ffp-contract=off) where
/// the instruction set has fused operations.

#include "scintray/core/number.hpp"

namespace scintray::core {

template <typename Real>
struct SineCosineOf {
  Real sine, cosine;
};
namespace laws {

namespace detail {

/// Sine and cosine of r (rad) within pi/4 of zero.
template <typename Real>
constexpr SineCosineOf<Real> sincos_near_zero(const Real& r) {
  const Real z = r * r;
  const Real odd =
      Real(-1.66666666666666324348e-01) +
      z * (Real(8.33333333332248946124e-03) +
           z * (Real(-1.98412698298579493134e-04) +
                z * (Real(2.75573137070700676789e-06) +
                     z * (Real(-2.50507602534068634195e-08) + z * Real(1.58969099521155010221e-10)))));
  const Real even =
      Real(4.16666666666666019037e-02) +
      z * (Real(-1.38888888888741095749e-03) +
           z * (Real(2.48015872894767294178e-05) +
                z * (Real(-2.75573143513906633035e-07) +
                     z * (Real(2.08757232129817482790e-09) + z * Real(-1.13596475577881948265e-11)))));
  return {r + r * z * odd, Real(1.0) - Real(0.5) * z + z * z * even};
}

/// The nearest whole number of a number within 2^51 of zero, and the lowest bits of that whole number.
template <typename Real>
struct NearestWhole {
  Real value;
  BitsOf<Real> bits;

  constexpr explicit NearestWhole(const Real& x)
      : value((x + Real(kShift)) - Real(kShift)), bits(bits_of(x + Real(kShift))) {}

 private:
  static constexpr double kShift = 0x1.8p52;
};

/// Sine and cosine of an angle that is `turn` times a quarter turn more than the given one's. Without
/// branches: the quarter is often random.
template <typename Real>
constexpr SineCosineOf<Real> turned_by_quarters(const SineCosineOf<Real>& of, const BitsOf<Real>& turn) {
  using Bits = BitsOf<Real>;
  const Bits sine = bits_of(of.sine), cosine = bits_of(of.cosine), one(1), two(2);
  const Bits exchanged = (sine ^ cosine) & (Bits(0) - (turn & one));
  return {number_of((sine ^ exchanged) ^ ((turn & two) << 62)),
          number_of((cosine ^ exchanged) ^ (((turn + one) & two) << 62))};
}

}  // namespace detail

/// Sine and cosine of an angle given as a share of a full turn, within 2^49 of zero, with an error below
/// 2e-16.
template <typename Real>
constexpr SineCosineOf<Real> sincos_of_turn(const Real& turns) {
  constexpr double kQuarter_rad = 1.57079632679489661923;
  const Real quarters = Real(4.0) * turns;
  const detail::NearestWhole<Real> whole(quarters);
  return detail::turned_by_quarters<Real>(
      detail::sincos_near_zero<Real>((quarters - whole.value) * Real(kQuarter_rad)), whole.bits);
}

/// Sine and cosine of an angle (rad) within 1000 of zero, with an error below 2e-16.
template <typename Real>
constexpr SineCosineOf<Real> sincos(const Real& angle_rad) {
  // Half a pi in two parts, the first of 33 bits (fdlibm, e_rem_pio2.c).
  constexpr double kQuartersPerRad = 6.36619772367581382433e-01, kQuarter_rad = 1.57079632673412561417e+00,
                   kRest_rad = 6.07710050650619224932e-11;
  const detail::NearestWhole<Real> whole(angle_rad * Real(kQuartersPerRad));
  return detail::turned_by_quarters<Real>(
      detail::sincos_near_zero<Real>((angle_rad - whole.value * Real(kQuarter_rad)) -
                                     whole.value * Real(kRest_rad)),
      whole.bits);
}

/// Natural logarithm of a normal positive number.
template <typename Real>
constexpr Real log(const Real& x) {
  using Bits = BitsOf<Real>;
  constexpr std::uint64_t kRootHalf = 0x3fe6a09e667f3bcd, kBias = 1023;
  constexpr double kLog2High = 6.93147180369123816490e-01, kLog2Low = 1.90821492927058770002e-10;
  // x = 2^k m with m from sqrt(1/2) to sqrt(2).
  const Bits bits = bits_of(x);
  const Bits biased = (bits + Bits((kBias << 52) - kRootHalf)) >> 52;
  const Real k = value_of<Real>(biased) - Real(static_cast<double>(kBias));
  const Real f = number_of(bits - ((biased - Bits(kBias)) << 52)) - Real(1.0);
  const Real s = f / (Real(2.0) + f), z = s * s, w = z * z, half = Real(0.5) * f * f;
  const Real even = w * (Real(3.999999999940941908e-01) +
                         w * (Real(2.222219843214978396e-01) + w * Real(1.531383769920937332e-01)));
  const Real odd = z * (Real(6.666666666666735130e-01) +
                        w * (Real(2.857142874366239149e-01) +
                             w * (Real(1.818357216161805012e-01) + w * Real(1.479819860511658591e-01))));
  return k * Real(kLog2High) - ((half - (s * (half + (even + odd)) + k * Real(kLog2Low))) - f);
}

}  // namespace laws
}  // namespace scintray::core
