#pragma once
/// Mending one mesh file, or the meshes of a scene, and what the program prints about it.

#include <filesystem>

#include "scintray/mesh/import/import.hpp"
#include "scintray/mesh/repair/repair.hpp"

namespace scintray::cli {

/// Reads, mends and writes a mesh, and prints what was found, done and left. The ending of `out` states
/// the format: .stl (millimetres, groups are lost), .ply (the same in double precision) or .glb (metres, a
/// primitive for each group, and a node called after the body that was requested, else after the file).
/// What was written is read back before it is called sound. Returns whether it is.
/// @throws InputError for what cannot be read and other endings, SystemError when nothing can be written.
[[nodiscard]] bool repair_file(const std::filesystem::path& in, const mesh::ImportOptions& options,
                               const std::filesystem::path& out, const mesh::RepairSettings& settings);

/// The ending that keeps all that a file has: ".ply" for PLY, ".stl" for STL of one solid, else ".glb".
const char* lossless_ending(const std::filesystem::path& in, const mesh::ImportOptions& options);

/// Mends the mesh of every part into the folder `out` and writes a copy of the scene there that names
/// the mended files; other files keep their places, and relative paths to them are rewritten. Meshes
/// that only a sweep names are left as they are. Returns whether every mesh is sound now.
/// @throws InputError for a scene that is no TOML or a mesh that cannot be read.
[[nodiscard]] bool repair_scene(const std::filesystem::path& scene, const std::filesystem::path& out,
                                const mesh::RepairSettings& settings);

}  // namespace scintray::cli
