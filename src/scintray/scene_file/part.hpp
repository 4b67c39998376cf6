#pragma once
/// [[part]], a body of the scene, and [[part.face]], the rules of its faces. Lengths mm, angles rad.

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scintray/config/name_ref.hpp"
#include "scintray/config/toml_reader.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/mesh/trimesh.hpp"
#include "scintray/scene_file/placement.hpp"
#include "scintray/scene_file/shape.hpp"

namespace scintray::scene_file {

/// Name of the medium that absorbs all light that enters it.
inline constexpr const char* kOpaqueMedium = "opaque";

/// Largest magnitude of a part's priority.
inline constexpr int kHighestPriority = 1000;

/// Suffix that, added to the name of a part, names the part that fills the gap under it.
inline constexpr const char* kFillSuffix = "_fill";

/// Name of the face made of a part's triangles that no rule matches; no rule may use it.
inline constexpr const char* kOtherFaces = "other";

/// Selection of triangles of a part in world coordinates, after placement. All criteria present apply
/// together, with the meaning of FaceSelector (mesh/face_selection.hpp).
struct FaceSelectorSpec {
  std::optional<core::Vec3> normal;  ///< unit; within `tolerance_rad` of the outward normal
  double tolerance_rad = core::kDegree;
  std::optional<BoxSpec> box;               ///< contains the whole triangle
  std::optional<core::Vec3> flat_region;    ///< point, mm: the connected flat patch nearest to it
  std::optional<core::Vec3> nearest;        ///< point, mm: the one triangle nearest to it
  std::optional<core::Vec3> smooth_region;  ///< point, mm: the smooth region of the triangle nearest to it
  config::NameRef smooth_around;            ///< the smooth regions of a group
  config::NameRef touches;                  ///< pattern of parts: the whole faces in contact with one
  std::optional<double> edge_angle_rad;     ///< where smooth regions end; none: mesh::kSmoothEdge
  config::NameRef group;                    ///< glTF material or OBJ group of the mesh file; side
                                            ///< "-z" of a box, "side" of a cylinder
  mesh::FaceTags tags;                      ///< glTF extras, "color" of a CAD face
  core::FileLocation where;
  bool operator==(const FaceSelectorSpec&) const = default;
};

/// A rule for some of a part's faces.
struct FaceRuleSpec {
  std::string name;  ///< unique within its part; by default the group, the part it touches, or the side
                     ///< ("-z") of a normal along an axis, or "face1", "face2"...
  FaceSelectorSpec select;
  config::NameRef surface;  ///< empty: the part's
  config::NameRef sensor;   ///< detects light that leaves the part here
  core::FileLocation where;
  bool operator==(const FaceRuleSpec&) const = default;
};

struct PartSpec {
  config::NameRef name;
  ShapeSpec shape;
  PlacementSpec placement;
  config::NameRef medium;   ///< kOpaqueMedium allowed; empty only for a part that is a sensor
  config::NameRef surface;  ///< of every face that no rule matches; empty: rules must cover every face
  config::NameRef sensor;   ///< the whole part is a sensor
  /// Directions of the principal axes x, y, z of a birefringent medium in the part's own frame, in columns;
  /// nothing: along the axes of that frame.
  std::optional<Eigen::Matrix3d> principal_axes;
  bool principal_x_given = false;  ///< else x and y are any directions perpendicular to z
  int priority = 0;  ///< of two overlapping parts the one with the higher priority keeps the volume
  std::vector<FaceRuleSpec> faces;
  bool liquid = false;  ///< glue or filler of a builder: its faces need no surface, they are smooth
  core::FileLocation where;
  bool operator==(const PartSpec&) const = default;
};

/// Parts of a builder ([[array]], [[light_guide]]) that are placed as one body. Their placements and the
/// selections of their face rules are in the builder's own frame.
struct GroupSpec {
  config::NameRef name;
  std::size_t first = 0;  ///< index of its first part in SceneSpec::parts; the others follow
  std::size_t count = 0;
  PlacementSpec placement;
  bool operator==(const GroupSpec&) const = default;
};

/// Definitions in the scene file, in the form of files of the material database, which parses them.
using InlineTables = std::map<std::string, config::TomlNodePtr>;

/// Face rules: [[face]] of a part, an element or an override.
std::vector<FaceRuleSpec> read_faces(const config::TomlTable& part);

/// Reads the keys of a [[part]] or of an element apart from its name and placement: shape, medium, sensor,
/// surface and faces.
void read_body(const config::TomlTable& table, PartSpec& part);

/// One [[part]]; `earlier` are the names that it may touch.
PartSpec read_part(const config::TomlTable& table, const std::vector<std::string>& earlier);

}  // namespace scintray::scene_file
