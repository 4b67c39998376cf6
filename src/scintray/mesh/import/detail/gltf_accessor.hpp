#pragma once
/// Typed, bounds-checked reading of glTF accessors.

#include <tiny_gltf.h>

#include <cstdint>
#include <filesystem>
#include <vector>

#include "scintray/core/vec.hpp"

namespace scintray::mesh {

/// Vertex positions. Throws InputError naming `path` unless the accessor is a dense float VEC3 that
/// lies wholly in its buffer.
std::vector<core::Vec3> read_positions(const tinygltf::Model& model, int accessor,
                                       const std::filesystem::path& path);

/// Vertex indices. Throws InputError unless the accessor is a dense unsigned integer SCALAR that lies
/// wholly in its buffer and every index is below `vertices`.
std::vector<std::uint32_t> read_indices(const tinygltf::Model& model, int accessor, std::size_t vertices,
                                        const std::filesystem::path& path);

}  // namespace scintray::mesh
