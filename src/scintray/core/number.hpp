#pragma once
/// Operations on numbers in which the laws of light transport are written once, for one photon (double) and
/// for several in the lanes of a vector register (lane_number.hpp). Every lane has the bits of the same
/// photon alone.
///
/// A law is a template over the number type, without branches on numbers: it selects between results by
/// masks. It includes nothing but headers of this kind, since lanes are compiled for instruction sets that
/// not every processor has; for the same reason what is no template is always
/// inlined.

#include <bit>
#include <cmath>
#include <cstdint>

namespace scintray::core {

/// Types that belong to a number type: the result of a comparison, and its bits as whole numbers.
template <typename Real>
struct NumberTypes {
  using Mask = typename Real::Mask;
  using Bits = typename Real::Bits;
};
template <>
struct NumberTypes<double> {
  using Mask = bool;
  using Bits = std::uint64_t;
};
template <typename Real>
using MaskOf = typename NumberTypes<Real>::Mask;
template <typename Real>
using BitsOf = typename NumberTypes<Real>::Bits;

[[gnu::always_inline]] inline constexpr double select(bool condition, double yes, double no) {
  return condition ? yes : no;
}
[[gnu::always_inline]] inline constexpr std::uint64_t bits_of(double x) {
  return std::bit_cast<std::uint64_t>(x);
}
[[gnu::always_inline]] inline constexpr double number_of(std::uint64_t bits) {
  return std::bit_cast<double>(bits);
}
/// The whole part of a number from 0 to 2^31.
[[gnu::always_inline]] inline double whole_part(double x) {
  return static_cast<double>(static_cast<std::int32_t>(x));
}
[[gnu::always_inline]] inline double root(double x) { return std::sqrt(x); }
[[gnu::always_inline]] inline constexpr double magnitude(double x) {
  return number_of(bits_of(x) & ~(std::uint64_t{1} << 63));
}

/// The bits moved to the left, those that leave at the left entering at the right.
template <int kCount>
[[gnu::always_inline]] inline constexpr std::uint64_t rotated(std::uint64_t bits) {
  return std::rotl(bits, kCount);
}

/// 1 with the sign of x.
template <typename Real>
Real sign_of(const Real& x) {
  using Bits = BitsOf<Real>;
  constexpr std::uint64_t kSign = std::uint64_t{1} << 63;
  return number_of((bits_of(x) & Bits(kSign)) | bits_of(Real(1.0)));
}

/// The smaller and the larger of two numbers; `b` where they are not ordered.
template <typename Real>
Real least(const Real& a, const Real& b) {
  return select(a < b, a, b);
}
template <typename Real>
Real greatest(const Real& a, const Real& b) {
  return select(a > b, a, b);
}

/// The value of a whole number below 2^52: the last bits of a number whose other bits are fixed.
template <typename Real>
constexpr Real value_of(const BitsOf<Real>& whole) {
  return number_of(whole | BitsOf<Real>(bits_of(0x1.0p52))) - Real(0x1.0p52);
}
/// The bits of a whole number below 2^32, of which the lower 32 are its value.
template <typename Real>
BitsOf<Real> whole_bits_of(const Real& whole) {
  return bits_of(whole + Real(0x1.0p52));
}

/// 64 random bits as a number uniform on [1, 2), by the first 52 of them.
template <typename Real>
Real uniform_above_one(const BitsOf<Real>& bits) {
  return number_of((bits >> 12) | BitsOf<Real>(bits_of(1.0)));
}
/// As a number uniform on [0, 1), of 52 bits.
template <typename Real>
Real uniform_of(const BitsOf<Real>& bits) {
  return uniform_above_one<Real>(bits) - Real(1.0);
}
/// As a number uniform on (0, 1]: safe as the argument of a logarithm.
template <typename Real>
Real uniform_positive_of(const BitsOf<Real>& bits) {
  return Real(2.0) - uniform_above_one<Real>(bits);
}

/// Three coordinates. Products are added in the order of Eigen's, whose bits they have.
template <typename Real>
struct Triple {
  Real x, y, z;

  friend Triple operator+(const Triple& a, const Triple& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Triple operator-(const Triple& a, const Triple& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Triple operator-(const Triple& a) { return {-a.x, -a.y, -a.z}; }
  friend Triple operator*(const Real& s, const Triple& a) { return {s * a.x, s * a.y, s * a.z}; }
  friend Real dot(const Triple& a, const Triple& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  friend Triple cross(const Triple& a, const Triple& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
  friend Triple select(const MaskOf<Real>& condition, const Triple& yes, const Triple& no) {
    return {select(condition, yes.x, no.x), select(condition, yes.y, no.y), select(condition, yes.z, no.z)};
  }
  /// Of unit length; zero stays zero. One division: those of wide vectors take as long as ten products.
  friend Triple normalised(const Triple& a) {
    const Real square = dot(a, a);
    return (Real(1.0) / select(square > Real(0.0), root(square), Real(1.0))) * a;
  }
  /// Of unit length, of a vector that is so but for rounding: a step of Newton's method for 1 over the root,
  /// after which an error e of the square is one of 3/8 e^2 in the length.
  friend Triple rounded_to_unit(const Triple& a) { return (Real(1.5) - Real(0.5) * dot(a, a)) * a; }
  friend MaskOf<Real> is_zero(const Triple& a) {
    const Real zero(0.0);
    return (a.x == zero) & (a.y == zero) & (a.z == zero);
  }
};

/// Mirror image of the direction d in a plane with unit normal n (either orientation), by its component along
/// n; of one that is 0 the direction itself.
template <typename Real>
Triple<Real> mirrored(const Triple<Real>& d, const Triple<Real>& n, const Real& along) {
  return d - (Real(2.0) * along) * n;
}
/// The same, of any direction.
template <typename Real>
Triple<Real> mirrored(const Triple<Real>& d, const Triple<Real>& n) {
  return mirrored(d, n, dot(d, n));
}

/// Two unit vectors across a unit vector, which form a right-handed frame with it.
/// Source: T. Duff et al. 2017, "Building an Orthonormal Basis, Revisited", JCGT 6(1), listing 3.
template <typename Real>
struct Across {
  Triple<Real> x, y;

  Across(const Triple<Real>& first, const Triple<Real>& second) : x(first), y(second) {}
  explicit Across(const Triple<Real>& axis) : Across(axis, sign_of(axis.z)) {}

 private:
  Across(const Triple<Real>& axis, const Real& sign) : Across(axis, sign, Real(-1.0) / (sign + axis.z)) {}
  Across(const Triple<Real>& axis, const Real& sign, const Real& a)
      : Across(axis, sign, a, axis.x * axis.y * a) {}
  Across(const Triple<Real>& axis, const Real& sign, const Real& a, const Real& b)
      : x{Real(1.0) + sign * axis.x * axis.x * a, sign * b, -sign * axis.x},
        y{b, sign + axis.y * axis.y * a, -axis.y} {}
};

}  // namespace scintray::core
