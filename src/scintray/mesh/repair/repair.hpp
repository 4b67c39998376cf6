#pragma once
/// Mending meshes.

#include <string>
#include <vector>

#include "scintray/mesh/diagnosis.hpp"

namespace scintray::mesh {

struct RepairSettings {
  /// Vertices closer than this along every axis become one; never less than single-precision rounding.
  double weld_mm = 0.0;
  /// Holes whose bounding box has a longer diagonal stay open. 0: a quarter of the mesh's diagonal.
  double largest_hole_mm = 0.0;
};

/// One kind of change, how often it was made, and where first.
struct RepairStep {
  std::string what;  ///< "duplicate triangles removed"
  Defects where;
};

struct RepairedMesh {
  TriMesh mesh;  ///< groups kept per triangle; what fills a hole takes its neighbours'
  std::vector<RepairStep> steps;
  std::vector<std::string> refused;  ///< what was tried in vain, and why, in words
  MeshDiagnosis before, after;
};

/// Welds vertices; takes out triangles without area, duplicates, fins, and walls inside; makes
/// neighbours agree and normals point outwards; fills holes; unites bodies that cross; and replaces
/// local self-intersections. Bodies that do not cross stay separate. What could not be mended is what
/// `after` still finds; a sound mesh comes back as it is.
/// @throws InputError when a triangle names a vertex that does not exist or a vertex is not finite.
[[nodiscard]] RepairedMesh repair_mesh(TriMesh mesh, const RepairSettings& settings = {});

}  // namespace scintray::mesh
