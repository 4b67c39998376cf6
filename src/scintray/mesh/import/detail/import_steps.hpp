#pragma once
/// Steps of the import after the reader of a format has returned its mesh.

#include <filesystem>
#include <string>
#include <vector>

#include "scintray/mesh/import/import.hpp"
#include "scintray/mesh/import/raw_mesh.hpp"

namespace scintray::mesh {

/// Factor from the coordinates to mm. `given_mm` is the unit that the user states, 0 for none. Adds a note
/// when it replaces the unit that the format prescribes. Throws InputError when neither the file, its format
/// nor the user states a unit, and when the user's contradicts that of the file itself.
double resolve_unit(const std::filesystem::path& path, double given_mm, const FileUnit& unit,
                    std::vector<std::string>& notes);

/// Triangles of a file, with plain names, of a format of `options`. Throws InputError as import_mesh().
RawMesh read_raw(const std::filesystem::path& path, const ImportOptions& options);

/// The import of what read_raw() returned.
MeshImport import_raw(const std::filesystem::path& path, RawMesh raw, const ImportOptions& options);

/// A copy of the body named `wanted`, or with that number, as choose_body() keeps it, without the list of
/// bodies. Throws InputError, which names the bodies, when none matches.
RawMesh copy_of_body(const std::filesystem::path& path, const RawMesh& raw, const std::string& wanted);

/// Keeps the body named `wanted`, or with that number from 1 on, with its vertices and groups. Empty keeps
/// all bodies, with a note when there are several. Throws InputError, which names the bodies, when none
/// matches.
void choose_body(const std::filesystem::path& path, RawMesh& raw, const std::string& wanted);

}  // namespace scintray::mesh
