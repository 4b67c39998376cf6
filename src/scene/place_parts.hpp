#pragma once
/// Loads, places and tags the parts of a scene.

#include <string>
#include <vector>

#include "scintray/mesh/diagnosis.hpp"
#include "scintray/mesh/trimesh.hpp"
#include "scintray/scene/spec.hpp"

namespace scintray {

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

/// The rotations of a placement as one.
Eigen::Matrix3d rotation_of(const PlacementSpec& placement);

/// Places every part of the scene, with the parts that fill gaps after the part they belong to.
/// Adds to `problems`: unreadable or unsound meshes, faces that two rules match, rules that match
/// nothing, faces without a surface, touching a part that does not stand earlier. A part with
/// problems may be missing from the result. Of a builder's parts only the first with problems tells them.
std::vector<PlacedMesh> place_parts(const SceneSpec& spec, Problems& problems);

}  // namespace scintray
