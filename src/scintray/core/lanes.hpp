#pragma once
/// Three coordinates and a fourth number in vector registers (GCC's and Clang's vector types), for the few
/// hot kernels of photon transport, where Eigen's types would go through memory.

#include "scintray/core/vec.hpp"

namespace scintray::core {

using TwoDoubles [[gnu::vector_size(16)]] = double;
using FourFloats [[gnu::vector_size(16)]] = float;

struct Lanes {
  TwoDoubles xy, zw;

  Lanes(TwoDoubles first, TwoDoubles last) : xy(first), zw(last) {}
  Lanes(const Vec3& v, double fourth) : xy{v.x(), v.y()}, zw{v.z(), fourth} {}
  /// Four numbers.
  static Lanes at(const double* numbers) {
    using Anywhere [[gnu::vector_size(16), gnu::aligned(8), gnu::may_alias]] = double;
    return {*reinterpret_cast<const Anywhere*>(numbers), *reinterpret_cast<const Anywhere*>(numbers + 2)};
  }

  Vec3 vec() const { return {xy[0], xy[1], zw[0]}; }
  Lanes with_fourth(double fourth) const { return {xy, TwoDoubles{zw[0], fourth}}; }
  FourFloats floats() const {
    using TwoFloats [[gnu::vector_size(8)]] = float;
    const TwoFloats first = __builtin_convertvector(xy, TwoFloats);
    const TwoFloats last = __builtin_convertvector(zw, TwoFloats);
    return FourFloats{first[0], first[1], last[0], last[1]};
  }

  friend Lanes operator+(const Lanes& a, const Lanes& b) { return {a.xy + b.xy, a.zw + b.zw}; }
  friend Lanes operator-(const Lanes& a, const Lanes& b) { return {a.xy - b.xy, a.zw - b.zw}; }
  friend Lanes operator*(double factor, const Lanes& a) { return {factor * a.xy, factor * a.zw}; }
  /// Scalar product over all four numbers.
  friend double dot(const Lanes& a, const Lanes& b) {
    const TwoDoubles sums = a.xy * b.xy + a.zw * b.zw;
    return sums[0] + sums[1];
  }
};

}  // namespace scintray::core
