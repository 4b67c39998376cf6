#include "scintray/tally/detail/face_axes.hpp"

#include <cmath>

namespace scintray::tally {

std::array<core::Vec3, 2> face_axes(const core::Vec3& normal) {
  const core::Vec3 axis = std::abs(normal.x()) < 0.9 ? core::Vec3::UnitX() : core::Vec3::UnitY();
  const core::Vec3 first = (axis - normal.dot(axis) * normal).normalized();
  core::Vec3 second = normal.cross(first);
  Eigen::Index largest = 0;
  second.cwiseAbs().maxCoeff(&largest);
  if (second[largest] < 0.0) second = -second;
  return {first, second};
}

}  // namespace scintray::tally
