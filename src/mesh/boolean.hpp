#pragma once
/// Unions, differences and intersections of closed meshes.

#include "scintray/mesh/trimesh.hpp"

namespace scintray {

enum class BooleanOperation { join, subtract, intersect };

/// Both bodies, `a` without `b`, or what they have in common, by CGAL's corefinement with exact predicates.
/// Triangles of the result keep the group and tags of the mesh that they come from. The result may be
/// empty. Faces of the two that lie on each other are allowed.
/// @throws InputError when either mesh is not closed, crosses itself or is inside out, and when the result
///         would touch itself along an edge or in a corner, which no closed surface of triangles can.
TriMesh boolean(const TriMesh& a, const TriMesh& b, BooleanOperation operation);

}  // namespace scintray
