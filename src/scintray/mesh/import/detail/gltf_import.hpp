#pragma once
/// glTF 2.0 through tinygltf.

#include <filesystem>
#include <string>

#include "scintray/mesh/import/detail/raw_mesh.hpp"

namespace scintray::mesh {

/// Reads .gltf (text; buffers embedded or in files beside it) or .glb content. Coordinates in metres,
/// in glTF's axes (y up). Reads the default scene, else the first, else every root node; groups are
/// material names, tags the scalar extras of nodes, mesh, material and primitive, the later ones winning;
/// bodies are nodes with a mesh. Throws InputError for malformed files and for extensions that hide the
/// geometry.
RawMesh import_gltf(const std::filesystem::path& path, const std::string& content, bool binary);

}  // namespace scintray::mesh
