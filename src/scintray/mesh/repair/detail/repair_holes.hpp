#pragma once
/// Filling the holes of a mesh.

#include <cstddef>

#include "scintray/mesh/diagnosis.hpp"

namespace scintray::mesh {

struct HoleFilling {
  Defects filled;           ///< at a corner of each
  Defects too_large;        ///< left open
  double largest_mm = 0.0;  ///< diagonal of the bounding box of the largest of those left open
  Defects without_cover;    ///< CGAL found no surface over them
  std::size_t sheets = 0;   ///< bodies that would have enclosed nothing: left open
};

/// Fills holes whose bounding box has a diagonal of at most `limit_mm`. What fills a hole takes the group
/// of a triangle beside it. A sheet whose only hole is its own outline stays a sheet.
HoleFilling fill_holes(TriMesh& mesh, double limit_mm);

}  // namespace scintray::mesh
