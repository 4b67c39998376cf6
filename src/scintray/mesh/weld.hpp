#pragma once
/// Making one connected mesh out of the loose triangles that files hold.

#include <cstddef>

#include "scintray/mesh/trimesh.hpp"

namespace scintray::mesh {

/// Makes vertices closer than `length_mm` along every axis one vertex (the first of them stays), in
/// vertex order; vertices that no triangle uses go. Triangles stay, even those that collapse.
/// Returns how many vertices went.
std::size_t weld_vertices(TriMesh& mesh, double length_mm);

/// Vertices that no triangle uses go; the others keep their order.
void drop_unused_vertices(TriMesh& mesh);

struct DegenerateRemoval {
  std::size_t removed = 0;  ///< triangles without area that went
  std::size_t cut = 0;      ///< neighbours that were cut at the middle vertex of one
};

/// Takes out triangles without area (is_degenerate with `length_mm`). One with three different
/// vertices leaves a slit between its long edge and its middle vertex, so the neighbour across the
/// long edge is cut there: open edges do not appear.
DegenerateRemoval remove_degenerate(TriMesh& mesh, double length_mm);

}  // namespace scintray::mesh
