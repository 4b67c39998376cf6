#pragma once
/// Mending one mesh file, and what the program says of it.

#include <filesystem>

#include "scintray/mesh/repair.hpp"

namespace scintray::cli {

/// Reads, mends and writes a mesh, and prints what was found, done and left. The ending of `out` says
/// the format: .stl (millimetres, groups are lost) or .glb (metres, a primitive for each group).
/// What was written is read back before it is called sound. Returns whether it is.
/// @throws InputError for what cannot be read and other endings, SystemError when nothing can be written.
bool repair_file(const std::filesystem::path& in, double mm_per_unit, const std::filesystem::path& out,
                 const RepairSettings& settings);

/// The ending that keeps all that a file has: ".glb" for glTF and for meshes with several groups, else
/// ".stl".
const char* lossless_ending(const std::filesystem::path& in, double mm_per_unit);

}  // namespace scintray::cli
