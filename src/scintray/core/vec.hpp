#pragma once
/// Vectors and the geometric operations that every module uses.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace scintray::core {

/// A point (mm) or a direction (unit length), in double precision.
using Vec3 = Eigen::Vector3d;

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kTwoPi = 2.0 * std::numbers::pi;
inline constexpr double kDegree = std::numbers::pi / 180.0;

/// Speed of light in vacuum, mm/ns (exact, SI definition of the metre).
inline constexpr double kSpeedOfLight_mm_per_ns = 299.792458;

/// Right-handed orthonormal frame whose third axis is a given unit vector.
struct Frame {
  Vec3 x, y, z;

  /// Frame about the unit vector `axis`.
  /// Source: T. Duff et al. 2017, "Building an Orthonormal Basis, Revisited", JCGT 6(1), listing 3.
  static Frame about(const Vec3& axis) {
    const double sign = std::copysign(1.0, axis.z());
    const double a = -1.0 / (sign + axis.z());
    const double b = axis.x() * axis.y() * a;
    return {Vec3(1.0 + sign * axis.x() * axis.x() * a, sign * b, -sign * axis.x()),
            Vec3(b, sign + axis.y() * axis.y() * a, -axis.y()), axis};
  }

  Vec3 to_world(const Vec3& v) const { return v.x() * x + v.y() * y + v.z() * z; }
  Vec3 to_local(const Vec3& v) const { return {v.dot(x), v.dot(y), v.dot(z)}; }
};

/// Mirror image of the direction `d` in a plane with unit normal `n` (either orientation).
inline Vec3 mirror(const Vec3& d, const Vec3& n) { return d - (2.0 * d.dot(n)) * n; }

}  // namespace scintray::core
