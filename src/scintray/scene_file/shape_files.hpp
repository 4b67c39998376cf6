#pragma once
/// Meshes of shapes of which several may be in one file.

#include "scintray/mesh/import/import.hpp"
#include "scintray/scene_file/shape.hpp"

namespace scintray::scene_file {

/// As shape_mesh() of one shape, with files that several shapes name read once.
ShapeMesh shape_mesh(const ShapeSpec& shape, mesh::MeshFiles& files,
                     const mesh::MeshFormats& formats = mesh::MeshFormats::built_in());

}  // namespace scintray::scene_file
