#pragma once
/// Union, difference and intersection of closed meshes.

#include <cstdint>
#include <optional>
#include <vector>

#include "scintray/mesh/trimesh.hpp"

namespace scintray::mesh {

/// Boolean operation on two solids.
enum class BooleanOperation {
  unite,      ///< union
  subtract,   ///< difference: the first minus the second
  intersect,  ///< intersection
};

/// The triangle of an operand of which a triangle of the result is a piece.
struct TriangleOrigin {
  bool of_second = false;
  std::uint32_t triangle = 0;
};

struct BooleanResult {
  TriMesh mesh;                        ///< mm, outwards; its groups are those of the first mesh
  std::vector<TriangleOrigin> origin;  ///< per triangle
};

/// Boolean operation on two sound meshes (diagnose(...).sound()). Which triangles are cut, and where the
/// boundary of the result lies, is decided with exact predicates (CGAL's corefinement); only then are new
/// vertices rounded, those within `clean_mm` of each other welded, and triangles flatter than that removed.
/// Triangles from the second mesh have the group of the first mesh's first triangle; `origin` identifies
/// them.
///
/// Empty when CGAL fails: an operand crosses itself or bounds no volume, or the result would have
/// an edge of more than two triangles. An empty mesh when nothing is left.
[[nodiscard]] std::optional<BooleanResult> boolean(const TriMesh& first, const TriMesh& second,
                                                   BooleanOperation operation, double clean_mm);

/// The first of two sound meshes with its triangles cut along its intersection with the second; the solid is
/// unchanged. Cleaned and numbered as the result of boolean(), with all origins in the first. Empty when CGAL
/// fails.
[[nodiscard]] std::optional<BooleanResult> imprint(const TriMesh& first, const TriMesh& second,
                                                   double clean_mm);

/// Union, difference `a` minus `b`, or intersection of two bodies. Triangles of the result keep the group and
/// tags of the mesh that they come from. The result may be empty. Coplanar overlapping faces of the two
/// are allowed.
/// @throws InputError when either mesh is not closed, crosses itself or is inside out, and when the result
///         would touch itself along an edge, which is not a manifold.
[[nodiscard]] TriMesh combine(const TriMesh& a, const TriMesh& b, BooleanOperation operation);

}  // namespace scintray::mesh
