#pragma once
/// Welding the separate triangles of files into a connected mesh.

#include <cstddef>

#include "scintray/mesh/trimesh.hpp"

namespace scintray::mesh {

/// Merges vertices closer than `length_mm` along every axis (the first of them remains), in vertex order, and
/// removes vertices that no triangle uses. Triangles remain, even those that collapse. Returns the number of
/// vertices removed.
std::size_t weld_vertices(TriMesh& mesh, double length_mm);

/// Removes vertices that no triangle uses; the others keep their order.
void drop_unused_vertices(TriMesh& mesh);

}  // namespace scintray::mesh
