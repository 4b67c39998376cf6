#pragma once
/// Repair of meshes.

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

/// One kind of change, with its number and the positions of the first ones.
struct RepairStep {
  std::string what;  ///< "duplicate triangles removed"
  Defects where;
};

struct RepairedMesh {
  TriMesh mesh;  ///< groups kept per triangle; the filling of a hole takes those of its neighbours
  std::vector<RepairStep> steps;
  std::vector<std::string> refused;  ///< attempts that failed, with the reason
  MeshDiagnosis before, after;
};

/// A mesh repaired as follows: welds vertices; removes triangles without area, duplicates, fins, and inner
/// walls; orients neighbours consistently and normals outwards; fills holes; unites bodies that cross; and
/// replaces local self-intersections. Bodies that do not cross remain separate. What could not be repaired is
/// in `after`; a sound mesh is returned unchanged.
/// @throws InputError when a triangle names a vertex that does not exist or a vertex is not finite.
[[nodiscard]] RepairedMesh repair_mesh(TriMesh mesh, const RepairSettings& settings = {});

}  // namespace scintray::mesh
