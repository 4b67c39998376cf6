#pragma once
/// Export to formats that hold only triangles: STL and PLY.

#include <filesystem>

#include "scintray/mesh/trimesh.hpp"

namespace scintray::mesh {

/// Writes a binary STL with coordinates in mm, rounded to single precision (groups are lost: the format has
/// none). The file is written completely or not at all. @throws SystemError when it cannot be written
void write_stl(const std::filesystem::path& path, const TriMesh& mesh);

/// Writes a binary PLY with coordinates in mm, in double precision, so that bodies that touch still touch
/// after reading (groups are lost: the format has none). The file is written completely or not at all.
/// @throws SystemError when it cannot be written
void write_ply(const std::filesystem::path& path, const TriMesh& mesh);

}  // namespace scintray::mesh
