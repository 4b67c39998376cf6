#pragma once
/// Union, difference and intersection of closed meshes.

#include <cstdint>
#include <optional>
#include <vector>

#include "scintray/mesh/trimesh.hpp"

namespace scintray::mesh {

/// What to make of two solids.
enum class BooleanOperation {
  unite,      ///< all that is in one or the other
  subtract,   ///< the first less the second
  intersect,  ///< all that is in both
};

/// The triangle of an operand that a triangle of the result is a piece of.
struct TriangleOrigin {
  bool of_second = false;
  std::uint32_t triangle = 0;
};

struct BooleanResult {
  TriMesh mesh;                        ///< mm, outwards; its groups are those of the first mesh
  std::vector<TriangleOrigin> origin;  ///< per triangle
};

/// Combines two sound meshes (diagnose(...).sound()). Which triangles are cut, and where the result's
/// boundary runs, is decided exactly (CGAL's corefinement); only then are new vertices rounded, those
/// within `clean_mm` of each other welded, and triangles flatter than that taken out. Triangles from
/// the second mesh take the group of the first mesh's first triangle; their origin states what they are.
///
/// Nothing when CGAL refuses: an operand crosses itself or bounds no volume, or the result would have
/// an edge of more than two triangles. An empty mesh when nothing is left.
[[nodiscard]] std::optional<BooleanResult> boolean(const TriMesh& first, const TriMesh& second,
                                                   BooleanOperation operation, double clean_mm);

/// Cuts the triangles of the first of two sound meshes along their intersection with the second; the solid
/// stays what it is. Cleaned and numbered as the result of boolean(), all origins being in the first.
/// Nothing when CGAL refuses.
[[nodiscard]] std::optional<BooleanResult> imprint(const TriMesh& first, const TriMesh& second,
                                                   double clean_mm);

/// Both bodies, `a` without `b`, or what they have in common. Triangles of the result keep the group and
/// tags of the mesh that they come from. The result may be empty. Faces of the two that lie on each other
/// are allowed.
/// @throws InputError when either mesh is not closed, crosses itself or is inside out, and when the result
///         would touch itself along an edge, which no closed surface of triangles can.
[[nodiscard]] TriMesh combine(const TriMesh& a, const TriMesh& b, BooleanOperation operation);

}  // namespace scintray::mesh
