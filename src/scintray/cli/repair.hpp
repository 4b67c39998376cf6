#pragma once
/// Repair of one mesh file or of the meshes of a scene, with its report.

#include <filesystem>
#include <functional>

#include "scintray/mesh/diagnosis.hpp"
#include "scintray/mesh/import/import.hpp"
#include "scintray/mesh/repair/repair.hpp"

namespace scintray::cli {

/// Called for each mesh that was repaired: its file, its state as found and as written.
using RepairReport = std::function<void(const std::filesystem::path& file, const mesh::MeshDiagnosis& found,
                                        const mesh::MeshDiagnosis& written)>;

/// Repairs a mesh file and prints the defects found, repaired and left. The extension of `out` determines the
/// format: .stl (millimetres, groups are lost), .ply (the same in double precision) or .glb (metres, a
/// primitive for each group, and a node named after the requested body, else after the file). The written
/// file is read again before it is reported as sound. Returns whether it is.
/// @param report  called with the states of the mesh before and after
/// @throws InputError for unreadable files and other extensions, SystemError when the file cannot be written
[[nodiscard]] bool repair_file(const std::filesystem::path& in, const mesh::ImportOptions& options,
                               const std::filesystem::path& out, const mesh::RepairSettings& settings,
                               const RepairReport& report = {});

/// The extension that keeps all information of a file: ".ply" for PLY, ".stl" for STL of one solid, else
/// ".glb".
const char* lossless_ending(const std::filesystem::path& in, const mesh::ImportOptions& options);

/// Repairs the mesh of every part into the folder `out` and writes a copy of the scene there that names the
/// repaired files; other files are not moved, and relative paths to them are rewritten. Meshes named only
/// in a sweep are unchanged. Returns whether every mesh is sound now.
/// @param report  called for each mesh
/// @throws InputError for a scene that is not TOML or a mesh that cannot be read
[[nodiscard]] bool repair_scene(const std::filesystem::path& scene, const std::filesystem::path& out,
                                const mesh::RepairSettings& settings, const RepairReport& report = {});

}  // namespace scintray::cli
