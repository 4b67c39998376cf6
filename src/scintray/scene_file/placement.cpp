#include "scintray/scene_file/placement.hpp"

namespace scintray::scene_file {

Eigen::Matrix3d rotation_of(const PlacementSpec& placement) {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  for (const RotationSpec& turn : placement.rotate)
    rotation = Eigen::AngleAxisd(turn.angle_rad, turn.axis).toRotationMatrix() * rotation;
  return rotation;
}

}  // namespace scintray::scene_file
