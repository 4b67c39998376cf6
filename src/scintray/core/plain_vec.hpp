#pragma once
/// Trivially copyable vectors and matrices, which Eigen's are not: for records that are copied as bytes, to
/// another process or to a device. Arithmetic is Eigen's.

#include <array>
#include <type_traits>

#include "scintray/core/vec.hpp"

namespace scintray::core {

/// Three coordinates. Not initialised by default, as Vec3.
class PlainVec3 {
 public:
  PlainVec3() = default;
  PlainVec3(double x, double y, double z) : xyz_{x, y, z} {}
  template <typename Derived>
  PlainVec3(const Eigen::MatrixBase<Derived>& v)  // NOLINT(google-explicit-constructor)
      : PlainVec3(Vec3(v)) {}
  PlainVec3(const Vec3& v) : xyz_{v.x(), v.y(), v.z()} {}  // NOLINT(google-explicit-constructor)

  Vec3 vec() const { return {xyz_[0], xyz_[1], xyz_[2]}; }
  operator Vec3() const { return vec(); }  // NOLINT(google-explicit-constructor)

  double x() const { return xyz_[0]; }
  double y() const { return xyz_[1]; }
  double z() const { return xyz_[2]; }
  double& x() { return xyz_[0]; }
  double& y() { return xyz_[1]; }
  double& z() { return xyz_[2]; }
  double operator[](int axis) const { return xyz_[static_cast<std::size_t>(axis)]; }
  double& operator[](int axis) { return xyz_[static_cast<std::size_t>(axis)]; }

  double dot(const Vec3& other) const { return vec().dot(other); }
  Vec3 cross(const Vec3& other) const { return vec().cross(other); }
  double norm() const { return vec().norm(); }
  Vec3 normalized() const { return vec().normalized(); }
  void normalize() { *this = vec().normalized(); }
  bool isZero(double precision) const { return vec().isZero(precision); }

  PlainVec3& operator+=(const Vec3& other) { return *this = vec() + other; }
  friend Vec3 operator+(const PlainVec3& a, const PlainVec3& b) { return a.vec() + b.vec(); }
  friend Vec3 operator-(const PlainVec3& a, const PlainVec3& b) { return a.vec() - b.vec(); }
  friend Vec3 operator-(const PlainVec3& a) { return -a.vec(); }
  friend Vec3 operator*(double factor, const PlainVec3& a) { return factor * a.vec(); }
  friend bool operator==(const PlainVec3& a, const PlainVec3& b) { return a.xyz_ == b.xyz_; }

 private:
  std::array<double, 3> xyz_;
};

/// A 3 x 3 matrix, columns first. Not initialised by default.
class PlainMatrix3 {
 public:
  PlainMatrix3() = default;
  PlainMatrix3(const Eigen::Matrix3d& m)  // NOLINT(google-explicit-constructor)
      : columns_{m.col(0), m.col(1), m.col(2)} {}

  static PlainMatrix3 identity() { return Eigen::Matrix3d(Eigen::Matrix3d::Identity()); }

  const PlainVec3& column(std::size_t i) const { return columns_[i]; }
  Vec3 row(int i) const { return {columns_[0][i], columns_[1][i], columns_[2][i]}; }
  Eigen::Matrix3d matrix() const {
    Eigen::Matrix3d m;
    for (int i = 0; i < 3; ++i) m.col(i) = columns_[static_cast<std::size_t>(i)].vec();
    return m;
  }

 private:
  std::array<PlainVec3, 3> columns_;
};

static_assert(std::is_trivially_copyable_v<PlainVec3> && sizeof(PlainVec3) == 3 * sizeof(double));
static_assert(std::is_trivially_copyable_v<PlainMatrix3> && sizeof(PlainMatrix3) == 9 * sizeof(double));

inline Triple<double> triple(const PlainVec3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace scintray::core
