#pragma once
/// The passes of a repair, each over one mesh.

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "scintray/mesh/diagnosis.hpp"

namespace scintray::mesh {

/// The defects of edges only, as by diagnose(): open, non-manifold and flipped.
[[nodiscard]] MeshDiagnosis edge_defects(const TriMesh& mesh);

/// Removes triangles with the same three corners as others. One of them stays where its edges need it
/// for an even number of triangles; none where they are the two sides of an internal wall.
Defects remove_duplicates(TriMesh& mesh);

/// Removes flaps and inner walls, smallest first: pieces of surface at an edge of an odd number of
/// triangles, three or more, whose absence leaves two triangles, or none, at each of their outer edges.
Defects remove_fins(TriMesh& mesh);

/// Separates bodies that share edges or single vertices, by duplicating these. At an edge of several
/// triangles those two are paired that are the only ones of a piece of surface there, else those that enclose
/// one wedge of the solid. Returns the edges that were separated; those whose triangles cannot be paired are
/// unchanged.
/// @pre neighbours have consistent orientation (orient_outwards)
Defects part_touching_bodies(TriMesh& mesh);

struct HoleFilling {
  Defects filled;           ///< at a corner of each
  Defects too_large;        ///< left open
  double largest_mm = 0.0;  ///< diagonal of the bounding box of the largest of those left open
  Defects without_cover;    ///< CGAL found no surface over them
  std::size_t sheets = 0;   ///< bodies that would enclose no volume: left open
};

/// Fills holes whose bounding box has a diagonal of at most `limit_mm`. The fill has the group of a triangle
/// beside it. A sheet whose only hole is its own outline remains a sheet.
[[nodiscard]] HoleFilling fill_holes(TriMesh& mesh, double limit_mm);

/// Triangles (indices into `loop`) over a closed loop of three or more points, that minimise the largest
/// dihedral angle and then the area (P. Liepa 2003, "Filling holes in meshes"). They run against the loop: a
/// loop in the sense of the triangles at its open edges gives triangles of consistent orientation. Empty
/// when CGAL finds none.
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> triangulate_hole(const std::vector<core::Vec3>& loop);

/// Triangles (indices into `outline`) over a closed outline, in its sense, of least total area; long ones
/// have a slightly larger weight, which decides in flat holes. By dynamic programming over all
/// triangulations, in a time of the cube of the number of corners: for a few dozen. Empty when there are
/// none.
/// @param least_height_mm  a triangle is higher than this above its longest side
/// @param joined  true for two corners that no new edge may join
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> triangles_of_least_area(
    const std::vector<core::Vec3>& outline, double least_height_mm,
    const std::function<bool(std::size_t, std::size_t)>& joined);

struct CrossFree {
  TriMesh mesh;
  Defects left_out;              ///< vertices that the mesh no longer has
  double farthest_mm = 0.0;      ///< largest distance of one of them from the triangles in its place
  std::size_t remaining = 0;     ///< pairs of triangles that still cross
  std::size_t covers_tried = 0;  ///< covers of holes computed, accepted or not: a measure of the work
};

/// A closed mesh without some of its vertices, so that no triangles cross. Vertices in the most crossings are
/// removed first, each with the triangles around it, whose outline is covered by triangles of least area or,
/// where it has many corners, by a fan about its centre. A new triangle takes the group of the one that had
/// its side of the outline. Where more than a twentieth (chosen) of the vertices would be removed, or none
/// can be, or two sheets cross along a line of thousands of triangles, crossings remain.
/// @param crossings  of self_intersections()
[[nodiscard]] CrossFree without_crossings(TriMesh mesh,
                                          std::vector<std::pair<std::uint32_t, std::uint32_t>> crossings);

/// The mesh with the triangles that cross each other, and some around them, cut out and the holes filled
/// (CGAL's remove_self_intersections, which works where defects are local, without its smoothing: the time of
/// that grows with the fourth power of a vertex's number of edges). New triangles take the group of the first
/// triangle. Empty when the mesh is not a closed, consistently oriented surface or CGAL does not succeed.
[[nodiscard]] std::optional<TriMesh> untangled(const TriMesh& mesh);

}  // namespace scintray::mesh
