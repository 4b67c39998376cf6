#pragma once
/// Vectors and the geometric operations that every module uses.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "scintray/core/number.hpp"

namespace scintray::core {

/// A point (mm) or a direction (unit length), in double precision.
using Vec3 = Eigen::Vector3d;

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kTwoPi = 2.0 * std::numbers::pi;
inline constexpr double kDegree = std::numbers::pi / 180.0;  ///< rad

/// Speed of light in vacuum, mm/ns (exact, SI definition of the metre).
inline constexpr double kSpeedOfLight_mm_per_ns = 299.792458;

/// A vector as the laws of light transport have it (number.hpp), and back.
inline Triple<double> triple(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
inline Vec3 vec(const Triple<double>& v) { return {v.x, v.y, v.z}; }

/// Right-handed orthonormal frame whose third axis is a given unit vector.
struct Frame {
  Vec3 x, y, z;

  /// Frame about the unit vector `axis`.
  static Frame about(const Vec3& axis) {
    const Across<double> across(triple(axis));
    return {vec(across.x), vec(across.y), axis};
  }

  Vec3 to_world(const Vec3& v) const { return v.x() * x + v.y() * y + v.z() * z; }
  Vec3 to_local(const Vec3& v) const { return {v.dot(x), v.dot(y), v.dot(z)}; }
};

/// Mirror image of the direction `d` in a plane with unit normal `n` (either orientation).
inline Vec3 mirror(const Vec3& d, const Vec3& n) { return vec(mirrored(triple(d), triple(n))); }

}  // namespace scintray::core
