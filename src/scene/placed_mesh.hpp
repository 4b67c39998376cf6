#pragma once
/// Parts in world coordinates, with a surface on each face: what contacts are found between.

#include <string>
#include <vector>

#include "scintray/mesh/diagnosis.hpp"
#include "scintray/mesh/trimesh.hpp"
#include "scintray/scene/name_ref.hpp"

namespace scintray {

/// What stands before the name of a part in the name of the faces that it leaves where it cuts another.
inline constexpr const char* kCutFaces = "cut:";

/// One face of a placed part.
struct PlacedFace {
  std::string name;  ///< within the part
  NameRef surface;   ///< empty: smooth
  NameRef sensor;    ///< empty: none
};

/// A part in world coordinates.
struct PlacedMesh {
  std::string name;
  FileLocation where;
  TriMesh mesh;
  std::vector<PlacedFace> faces;
  std::vector<std::uint32_t> face_of;  ///< per triangle, index into `faces`
  NameRef surface;                     ///< of faces that no rule matches; may be empty
  bool needs_surface = true;           ///< not so for sensors, opaque parts, glue and fillers
  int priority = 0;                    ///< see PartSpec
  NameRef medium;                      ///< empty only where the part is a sensor
  NameRef sensor;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  MeshDiagnosis diagnosis;
  std::vector<std::string> notes;  ///< what importing left out or turned round
};

}  // namespace scintray
