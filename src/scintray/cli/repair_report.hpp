#pragma once
/// Mending one mesh file, and what the program prints about it.

#include <filesystem>

#include "scintray/mesh/import/import.hpp"
#include "scintray/mesh/repair/repair.hpp"

namespace scintray::cli {

/// Reads, mends and writes a mesh, and prints what was found, done and left. The ending of `out` states
/// the format: .stl (millimetres, groups are lost), .ply (the same in double precision) or .glb (metres, a
/// primitive for each group, and a node called after the body that was requested, else after the file).
/// What was written is read back before it is called sound. Returns whether it is.
/// @throws InputError for what cannot be read and other endings, SystemError when nothing can be written.
bool repair_file(const std::filesystem::path& in, const mesh::ImportOptions& options,
                 const std::filesystem::path& out, const mesh::RepairSettings& settings);

/// The ending that keeps all that a file has: ".ply" for PLY, ".stl" for STL of one solid, else ".glb".
const char* lossless_ending(const std::filesystem::path& in, const mesh::ImportOptions& options);

}  // namespace scintray::cli
