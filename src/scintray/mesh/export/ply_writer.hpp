#pragma once
/// Writing PLY files.

#include <filesystem>

#include "scintray/mesh/trimesh.hpp"

namespace scintray::mesh {

/// Writes a binary PLY with coordinates in mm, in double precision, so that bodies that touch still touch
/// after reading (groups are lost: the format has none). The file appears whole or not at all.
/// @throws SystemError when it cannot.
void write_ply(const std::filesystem::path& path, const TriMesh& mesh);

}  // namespace scintray::mesh
