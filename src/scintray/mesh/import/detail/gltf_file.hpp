#pragma once
/// Loading of a glTF file with its buffers.

#include <tiny_gltf.h>

#include <filesystem>
#include <string>
#include <vector>

namespace scintray::mesh {

/// The model of a glTF 2.0 file by tinygltf, without pictures. Buffers are read from the file or from beside
/// it. Throws InputError naming `path`.
/// @param whole   content of the file
/// @param binary  .glb, else text
/// @param notes   receives tinygltf's warnings
tinygltf::Model load_gltf(const std::filesystem::path& path, const std::string& whole, bool binary,
                          std::vector<std::string>& notes);

}  // namespace scintray::mesh
