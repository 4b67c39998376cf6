#include "scintray/scene/placement.hpp"

namespace scintray {

Eigen::Matrix3d rotation_of(const PlacementSpec& placement) {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  for (const RotationSpec& turn : placement.rotate)
    rotation = Eigen::AngleAxisd(turn.angle_rad, turn.axis).toRotationMatrix() * rotation;
  return rotation;
}

}  // namespace scintray
