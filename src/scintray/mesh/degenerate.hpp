#pragma once
/// Removal of triangles without area, so that no open edges arise.

#include <cstddef>

#include "scintray/mesh/trimesh.hpp"

namespace scintray::mesh {

struct DegenerateRemoval {
  std::size_t removed = 0;  ///< triangles that were removed
  std::size_t cut = 0;      ///< neighbours that were cut at the middle vertex of one
  std::size_t merged = 0;   ///< middle vertices that were merged with a neighbour instead
};

/// Removes triangles without area (is_degenerate with `length_mm`). One with three different
/// vertices leaves a slit between its long edge and its middle vertex, so the neighbour across the
/// long edge is cut there: no open edges arise. Where cutting only shifts slivers, along a smooth border of
/// closely spaced vertices, the middle vertex is merged with an end of the long edge, if that moves no
/// triangle beside it by more than twice `length_mm`.
DegenerateRemoval remove_degenerate(TriMesh& mesh, double length_mm);

}  // namespace scintray::mesh
