#pragma once
/// Logarithm, sine and cosine for light transport. Unlike those of a mathematical library, whose bits depend
/// on the processor, they are sums and products in a fixed order: the same bits on every processor, and in
/// every lane of a vector.
///
/// Polynomials: those of fdlibm (Sun Microsystems 1993: e_log.c, k_sin.c, k_cos.c), with errors below 1 ulp
/// where the argument is exact. Compile without contraction of products and sums (-ffp-contract=off) where
/// the instruction set has fused operations.

#include <bit>
#include <cstdint>

namespace scintray::core {

struct SineCosine {
  double sine, cosine;
};

namespace detail {

/// Sine and cosine of r (rad) within pi/4 of zero.
constexpr SineCosine sincos_near_zero(double r) {
  const double z = r * r;
  const double odd = -1.66666666666666324348e-01 +
                     z * (8.33333333332248946124e-03 +
                          z * (-1.98412698298579493134e-04 +
                               z * (2.75573137070700676789e-06 +
                                    z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10))));
  const double even = 4.16666666666666019037e-02 +
                      z * (-1.38888888888741095749e-03 +
                           z * (2.48015872894767294178e-05 +
                                z * (-2.75573143513906633035e-07 +
                                     z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11))));
  return {r + r * z * odd, 1.0 - 0.5 * z + z * z * even};
}

/// The nearest whole number, for |x| below 2^51.
constexpr double nearest_whole(double x) {
  constexpr double kShift = 0x1.8p52;
  return (x + kShift) - kShift;
}

/// Sine and cosine of an angle that is `quarters` times a quarter turn more than the given one's. Without
/// branches: the quarter is often random.
constexpr SineCosine turned_by_quarters(const SineCosine& of, std::int64_t quarters) {
  const auto turn = static_cast<std::uint64_t>(quarters);
  const auto sine = std::bit_cast<std::uint64_t>(of.sine), cosine = std::bit_cast<std::uint64_t>(of.cosine);
  const std::uint64_t exchanged = (sine ^ cosine) & (0 - (turn & 1));
  return {std::bit_cast<double>((sine ^ exchanged) ^ ((turn & 2) << 62)),
          std::bit_cast<double>((cosine ^ exchanged) ^ (((turn + 1) & 2) << 62))};
}

}  // namespace detail

/// Sine and cosine of an angle given as a share of a full turn, within 2^49 of zero, with an error below
/// 2e-16.
constexpr SineCosine sincos_of_turn(double turns) {
  constexpr double kQuarter_rad = 1.57079632679489661923;
  const double quarters = 4.0 * turns;
  const double whole = detail::nearest_whole(quarters);
  return detail::turned_by_quarters(detail::sincos_near_zero((quarters - whole) * kQuarter_rad),
                                    static_cast<std::int64_t>(whole));
}

/// Sine and cosine of an angle (rad) within 1000 of zero, with an error below 2e-16.
constexpr SineCosine sincos(double angle_rad) {
  // Half a pi in two parts, the first of 33 bits (fdlibm, e_rem_pio2.c).
  constexpr double kQuartersPerRad = 6.36619772367581382433e-01, kQuarter_rad = 1.57079632673412561417e+00,
                   kRest_rad = 6.07710050650619224932e-11;
  const double whole = detail::nearest_whole(angle_rad * kQuartersPerRad);
  return detail::turned_by_quarters(
      detail::sincos_near_zero((angle_rad - whole * kQuarter_rad) - whole * kRest_rad),
      static_cast<std::int64_t>(whole));
}

/// Natural logarithm of a normal positive number.
constexpr double log(double x) {
  constexpr std::uint64_t kRootHalf = 0x3fe6a09e667f3bcd, kBias = 1023;
  constexpr double kLog2High = 6.93147180369123816490e-01, kLog2Low = 1.90821492927058770002e-10;
  // x = 2^k m with m from sqrt(1/2) to sqrt(2).
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const std::uint64_t biased = (bits - kRootHalf + (kBias << 52)) >> 52;
  const double k = static_cast<double>(static_cast<std::int64_t>(biased)) - static_cast<double>(kBias);
  const double f = std::bit_cast<double>(bits - ((biased - kBias) << 52)) - 1.0;
  const double s = f / (2.0 + f), z = s * s, w = z * z, half = 0.5 * f * f;
  const double even =
      w * (3.999999999940941908e-01 + w * (2.222219843214978396e-01 + w * 1.531383769920937332e-01));
  const double odd =
      z * (6.666666666666735130e-01 +
           w * (2.857142874366239149e-01 + w * (1.818357216161805012e-01 + w * 1.479819860511658591e-01)));
  return k * kLog2High - ((half - (s * (half + (even + odd)) + k * kLog2Low)) - f);
}

}  // namespace scintray::core
