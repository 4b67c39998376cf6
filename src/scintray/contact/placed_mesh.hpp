#pragma once
/// Parts in world coordinates, with a surface on each face: the input of contact finding.

#include <optional>
#include <string>
#include <vector>

#include "scintray/config/name_ref.hpp"
#include "scintray/mesh/diagnosis.hpp"
#include "scintray/mesh/trimesh.hpp"

namespace scintray::contact {

/// Prefix of the names of faces made by a cut; the name of the part that cut follows.
inline constexpr const char* kCutFaces = "cut:";

/// One face of a placed part.
struct PlacedFace {
  std::string name;         ///< within the part
  config::NameRef surface;  ///< empty: smooth
  config::NameRef sensor;   ///< empty: none
};

/// A part in world coordinates.
struct PlacedMesh {
  std::string name;
  core::FileLocation where;
  mesh::TriMesh mesh;
  std::vector<PlacedFace> faces;
  std::vector<std::uint32_t> face_of;  ///< per triangle, index into `faces`
  config::NameRef surface;             ///< of faces that no rule matches; may be empty
  bool needs_surface = true;           ///< false for sensors, opaque parts, glue and fillers
  int priority = 0;                    ///< see PartSpec
  config::NameRef medium;              ///< empty only where the part is a sensor
  config::NameRef sensor;
  /// Of a birefringent medium, in columns, in the frame of the part before its rotation; nothing: that
  /// frame's axes.
  std::optional<Eigen::Matrix3d> principal_axes;
  bool principal_x_given = false;  ///< else x and y are any directions perpendicular to z
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  mesh::MeshDiagnosis diagnosis;
  std::vector<std::string> notes;  ///< on omissions and reversals at import, and on later changes
};

}  // namespace scintray::contact
