#include "scintray/core/face_axes.hpp"

#include <cmath>

namespace scintray::core {

std::array<Vec3, 2> face_axes(const Vec3& normal) {
  const Vec3 axis = std::abs(normal.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
  const Vec3 first = (axis - normal.dot(axis) * normal).normalized();
  Vec3 second = normal.cross(first);
  Eigen::Index largest = 0;
  second.cwiseAbs().maxCoeff(&largest);
  if (second[largest] < 0.0) second = -second;
  return {first, second};
}

}  // namespace scintray::core
