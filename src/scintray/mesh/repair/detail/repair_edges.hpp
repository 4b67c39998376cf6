#pragma once
/// Mending edges of three or more triangles.

#include "scintray/mesh/diagnosis.hpp"

namespace scintray::mesh {

/// Takes out triangles with the same three corners as others. One of them stays where its edges need it
/// for an even number of triangles; none where they are the two sides of a wall inside.
Defects remove_duplicates(TriMesh& mesh);

/// Takes out flaps and walls inside, smallest first: pieces of surface at an edge of an odd number of
/// triangles, three or more, whose absence leaves two triangles, or none, at each of their outer edges.
Defects remove_fins(TriMesh& mesh);

/// Parts bodies that share edges or single vertices, by giving each body vertices of its own. At an edge
/// of several triangles those two belong together that are the only ones of a piece of surface there,
/// else those that enclose one wedge of the solid. Returns the edges that were parted; those whose
/// triangles do not pair up stay. Neighbours must agree (orient_outwards).
Defects part_touching_bodies(TriMesh& mesh);

}  // namespace scintray::mesh
