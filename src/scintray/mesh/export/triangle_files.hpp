#pragma once
/// Meshes written in formats that hold triangles alone: STL and PLY.

#include <filesystem>

#include "scintray/mesh/trimesh.hpp"

namespace scintray::mesh {

/// Writes a binary STL with coordinates in mm, rounded to single precision (groups are lost: the
/// format has none). The file appears whole or not at all. @throws SystemError when it cannot.
void write_stl(const std::filesystem::path& path, const TriMesh& mesh);

/// Writes a binary PLY with coordinates in mm, in double precision, so that bodies that touch still touch
/// after reading (groups are lost: the format has none). The file appears whole or not at all.
/// @throws SystemError when it cannot.
void write_ply(const std::filesystem::path& path, const TriMesh& mesh);

}  // namespace scintray::mesh
