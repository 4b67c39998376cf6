#pragma once
/// [[part.face]]: which of a part's faces are special, and how. Lengths mm, angles rad.

#include <optional>
#include <string>
#include <vector>

#include "scintray/config/name_ref.hpp"
#include "scintray/config/toml_reader.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/mesh/trimesh.hpp"
#include "scintray/scene_file/shape.hpp"

namespace scintray::scene_file {

/// Name of the face made of a part's triangles that no rule matches; no rule may have it.
inline constexpr const char* kOtherFaces = "other";

/// Picks triangles of a part in world coordinates, after placement. Every criterion given must hold; they
/// mean what they mean in FaceSelector (mesh/face_selection.hpp).
struct FaceSelectorSpec {
  std::optional<core::Vec3> normal;  ///< unit; within `tolerance_rad` of the outward normal
  double tolerance_rad = core::kDegree;
  std::optional<BoxSpec> box;             ///< the whole triangle lies in it
  std::optional<core::Vec3> flat_region;  ///< point, mm: the connected flat patch nearest to it
  std::optional<core::Vec3> nearest;      ///< point, mm: the one triangle nearest to it
  config::NameRef group;                  ///< glTF material or OBJ group of the mesh file; side
                                          ///< "-z" of a box, "side" of a cylinder
  mesh::FaceTags tags;                    ///< glTF extras, "color" of a CAD face
  core::FileLocation where;
  bool operator==(const FaceSelectorSpec&) const = default;
};

/// What is special about some of a part's faces.
struct FaceRuleSpec {
  std::string name;  ///< unique within its part; when not given, the group, or the side
                     ///< ("-z") of a normal along an axis, or "face1", "face2"...
  FaceSelectorSpec select;
  config::NameRef surface;  ///< empty: the part's
  config::NameRef sensor;   ///< light that crosses outwards here is detected by it
  core::FileLocation where;
  bool operator==(const FaceRuleSpec&) const = default;
};

/// [[face]] of a part, an element or an override.
std::vector<FaceRuleSpec> read_faces(const config::TomlTable& part);

}  // namespace scintray::scene_file
