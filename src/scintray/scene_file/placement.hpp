#pragma once
/// Placement of parts and builders in a scene file. Lengths mm, angles rad.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "scintray/config/name_ref.hpp"
#include "scintray/config/toml_reader.hpp"
#include "scintray/core/vec.hpp"

namespace scintray::scene_file {

/// A rotation about an axis through the origin of the part's own frame.
struct RotationSpec {
  core::Vec3 axis = core::Vec3::UnitZ();  ///< unit vector
  double angle_rad = 0.0;                 ///< counter-clockwise seen against the axis
  core::FileLocation where;
  bool operator==(const RotationSpec&) const = default;
};

/// A side of a bounding box.
struct BoxSide {
  int axis = 2;   ///< 0, 1, 2 for x, y, z
  int sign = -1;  ///< -1 or +1
  bool operator==(const BoxSide&) const = default;
};
inline constexpr core::Word<BoxSide> kBoxSides[] = {{"-x", {0, -1}}, {"+x", {0, +1}}, {"-y", {1, -1}},
                                                    {"+y", {1, +1}}, {"-z", {2, -1}}, {"+z", {2, +1}}};

/// Placement of a part against a side of another's bounding box, laterally centred on it.
struct TouchSpec {
  config::NameRef part;  ///< touched; a part or builder defined earlier in the file
  BoxSide side;          ///< of the touched part's bounding box
  double gap_mm = 0.0;
  config::NameRef fill;  ///< medium of the extra part "NAME_fill" that fills the gap: the overlap of
                         ///< both bounding boxes, as thick as the gap. Empty: the gap is ambient
  core::FileLocation where;
  bool operator==(const TouchSpec&) const = default;
};

/// Placement of a part: rotated (in order), then moved against another part, then translated.
struct PlacementSpec {
  std::vector<RotationSpec> rotate;
  std::optional<TouchSpec> touch;
  core::Vec3 translate = core::Vec3::Zero();  ///< mm
  bool operator==(const PlacementSpec&) const = default;
};

/// Placement from the keys rotate, place and translate; `earlier` are the names that may be touched.
PlacementSpec read_placement(const config::TomlTable& table, const std::vector<std::string>& earlier);

/// Rotations from the key rotate, one table or a list.
std::vector<RotationSpec> read_rotations(const config::TomlTable& part);

/// Product of the rotations of a placement.
Eigen::Matrix3d rotation_of(const PlacementSpec& placement);

}  // namespace scintray::scene_file
