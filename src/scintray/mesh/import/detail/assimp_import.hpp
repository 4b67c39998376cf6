#pragma once
/// STL, OBJ and OFF through assimp.

#include <filesystem>

#include "scintray/mesh/import/detail/raw_mesh.hpp"

namespace scintray::mesh {

/// Reads a file whose claimed sizes were checked. Throws InputError for what assimp cannot read.
RawMesh import_through_assimp(const std::filesystem::path& path);

}  // namespace scintray::mesh
