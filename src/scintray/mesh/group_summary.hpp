#pragma once
/// Size, position and direction of the groups of a mesh, for lists from which users select faces.

#include <string>
#include <vector>

#include "scintray/mesh/trimesh.hpp"

namespace scintray::mesh {

/// The triangles of all groups of one name.
struct GroupSummary {
  std::string name;
  std::string round;  ///< "sphere", "cylinder" or "cone" when all triangles approximate one; else empty
  double area_mm2 = 0.0;
  core::Vec3 centre = core::Vec3::Zero();  ///< of area, mm
  core::Vec3 area_vector_mm2 =
      core::Vec3::Zero();  ///< sum of normal times area: as long as the area when flat

  /// True when all triangles have one normal, to 1e-6 of the area.
  bool flat() const;
};

/// The groups of a mesh by name, the largest area first; of areas that are equal to 1e-6 in the order of
/// their names, numbers in them by value: "face2" before "face10".
std::vector<GroupSummary> summarize_groups(const TriMesh& mesh);

/// "12.3 mm2, centre (0, 0, 1) mm, flat, normal (0, 0, 1)"; "round (cylinder)" or "freeform" for others.
std::string text_of(const GroupSummary& group);

}  // namespace scintray::mesh
