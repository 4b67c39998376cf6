#pragma once
/// Defects of a mesh, with their positions.

#include <Eigen/Geometry>
#include <cstddef>
#include <string>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/mesh/trimesh.hpp"

namespace scintray::mesh {

/// Number of defects, and the positions of the first few (mm; at most kMaxExamples).
struct Defects {
  static constexpr std::size_t kMaxExamples = 5;
  std::size_t count = 0;
  std::vector<core::Vec3> examples;

  void add(const core::Vec3& place) {
    if (count++ < kMaxExamples) examples.push_back(place);
  }
};

/// Edges are counted once each; vertices count as the same only when they have the same index.
struct MeshDiagnosis {
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  Defects open_edges;            ///< edges of one triangle only
  Defects nonmanifold_edges;     ///< edges of three or more triangles
  Defects flipped_edges;         ///< edges whose two triangles run along them in the same direction
  Defects degenerate_triangles;  ///< no area (see is_degenerate)
  Defects duplicate_triangles;   ///< same three vertices as an earlier triangle, in any order
  Defects self_intersections;    ///< pairs of triangles that intersect other than in shared vertices/edges
  Defects inverted_bodies;       ///< closed bodies with inward normals, given their nesting
  std::size_t bodies = 0;        ///< sets of triangles connected through edges
  double volume_mm3 = 0.0;       ///< signed; meaningful when closed and consistently oriented
  double area_mm2 = 0.0;
  Eigen::AlignedBox3d bounds;  ///< of the vertices that triangles use; empty without triangles

  /// Every edge has exactly two triangles, and there is at least one triangle.
  bool closed() const { return triangles > 0 && open_edges.count == 0 && nonmanifold_edges.count == 0; }
  /// Triangles are oriented as their neighbours, and normals point out of the solid.
  bool outward() const { return flipped_edges.count == 0 && inverted_bodies.count == 0 && volume_mm3 > 0.0; }
  /// Usable as a part: closed, outward, and without self-intersection.
  bool sound() const {
    return closed() && outward() && self_intersections.count == 0 && degenerate_triangles.count == 0;
  }
};

/// Defects and measures of a mesh. Self-intersections come from CGAL polygon mesh processing with exact
/// predicates. Inverted bodies are only examined when the mesh is otherwise sound.
/// @throws InputError when a triangle names a vertex that does not exist or a vertex is not finite.
[[nodiscard]] MeshDiagnosis diagnose(const TriMesh& mesh);

/// Problems that make a part unusable, each with its count, a position in mm, and a hint; empty for sound
/// parts.
[[nodiscard]] std::vector<core::Problem> mesh_problems(const MeshDiagnosis& diagnosis,
                                                       const std::string& part_name);

/// Orients all triangles as their neighbours (where the mesh permits) and reverses triangles so that
/// normals point out of the solid, nested shells included. Returns true when any triangle was reversed.
/// Geometry, vertex numbers and triangle order are unchanged.
bool orient_outwards(TriMesh& mesh);

/// Shortest length (mm) that single precision resolves at the mesh's largest coordinate: 2^-22 of it.
double rounding_length(const TriMesh& mesh);

/// True when two vertices are the same or the height over the longest edge is at most `length_mm`.
[[nodiscard]] bool is_degenerate(const TriMesh& mesh, std::size_t triangle, double length_mm);

}  // namespace scintray::mesh
