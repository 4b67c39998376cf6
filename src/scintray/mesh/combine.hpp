#pragma once
/// Solids made of solids, with what is known of their faces.

#include "scintray/mesh/boolean.hpp"

namespace scintray::mesh {

/// Both bodies, `a` without `b`, or what they have in common. Triangles of the result keep the group and
/// tags of the mesh that they come from. The result may be empty. Faces of the two that lie on each other
/// are allowed.
/// @throws InputError when either mesh is not closed, crosses itself or is inside out, and when the result
///         would touch itself along an edge, which no closed surface of triangles can.
TriMesh combine(const TriMesh& a, const TriMesh& b, BooleanOperation operation);

}  // namespace scintray::mesh
