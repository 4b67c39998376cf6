#pragma once
/// Mending the meshes of a scene.

#include <filesystem>

#include "scintray/mesh/repair/repair.hpp"

namespace scintray::cli {

/// Mends the mesh of every part into the folder `out` and writes a copy of the scene there that names
/// the mended files; other files keep their places, and relative paths to them are rewritten. Meshes
/// that only a sweep names are left as they are. Returns whether every mesh is sound now.
/// @throws InputError for a scene that is no TOML or a mesh that cannot be read.
bool repair_scene(const std::filesystem::path& scene, const std::filesystem::path& out,
                  const mesh::RepairSettings& settings);

}  // namespace scintray::cli
