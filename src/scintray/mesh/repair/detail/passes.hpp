#pragma once
/// The passes of a repair, each over one mesh.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "scintray/mesh/diagnosis.hpp"

namespace scintray::mesh {

/// The defects of edges alone, as diagnose() finds them: open, non-manifold and flipped.
[[nodiscard]] MeshDiagnosis edge_defects(const TriMesh& mesh);

/// Removes triangles with the same three corners as others. One of them stays where its edges need it
/// for an even number of triangles; none where they are the two sides of a wall inside.
Defects remove_duplicates(TriMesh& mesh);

/// Removes flaps and inner walls, smallest first: pieces of surface at an edge of an odd number of
/// triangles, three or more, whose absence leaves two triangles, or none, at each of their outer edges.
Defects remove_fins(TriMesh& mesh);

/// Separates bodies that share edges or single vertices, by giving each body vertices of its own. At an edge
/// of several triangles those two belong together that are the only ones of a piece of surface there,
/// else those that enclose one wedge of the solid. Returns the edges that were separated; those whose
/// triangles do not pair up are unchanged. Neighbours must agree (orient_outwards).
Defects part_touching_bodies(TriMesh& mesh);

struct HoleFilling {
  Defects filled;           ///< at a corner of each
  Defects too_large;        ///< left open
  double largest_mm = 0.0;  ///< diagonal of the bounding box of the largest of those left open
  Defects without_cover;    ///< CGAL found no surface over them
  std::size_t sheets = 0;   ///< bodies that would enclose nothing: left open
};

/// Fills holes whose bounding box has a diagonal of at most `limit_mm`. The fill has the group of a triangle
/// beside it. A sheet whose only hole is its own outline remains a sheet.
[[nodiscard]] HoleFilling fill_holes(TriMesh& mesh, double limit_mm);

/// Triangles (indices into `loop`) over a closed loop of three or more points, of the smallest worst
/// dihedral angle and then area (P. Liepa 2003, "Filling holes in meshes"). They run against the loop:
/// a loop in the sense of the open edges' own triangles gives triangles that agree with those. Empty
/// when CGAL finds none.
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> triangulate_hole(const std::vector<core::Vec3>& loop);

/// The mesh with the triangles that cross each other, and some around them, replaced: smoothed, or cut
/// out and the hole filled (CGAL's remove_self_intersections, which works where defects are local).
/// New triangles take the group of the first triangle. Empty when the mesh is not a closed, consistently
/// oriented surface or CGAL does not succeed.
[[nodiscard]] std::optional<TriMesh> untangled(const TriMesh& mesh);

}  // namespace scintray::mesh
