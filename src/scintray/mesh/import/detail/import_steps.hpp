#pragma once
/// Steps of the import after the reader of a format has returned its mesh.

#include <filesystem>
#include <string>
#include <vector>

#include "scintray/mesh/import/raw_mesh.hpp"

namespace scintray::mesh {

/// Factor from the coordinates to mm. `given_mm` is the unit that the user states, 0 for none. Adds a note
/// when it replaces the unit that the format prescribes. Throws InputError when neither the file, its format
/// nor the user states a unit, and when the user's contradicts that of the file itself.
double resolve_unit(const std::filesystem::path& path, double given_mm, const FileUnit& unit,
                    std::vector<std::string>& notes);

/// Keeps the body named `wanted`, or with that number from 1 on, with its vertices and groups. Empty keeps
/// all bodies, with a note when there are several. Throws InputError, which names the bodies, when none
/// matches.
void choose_body(const std::filesystem::path& path, RawMesh& raw, const std::string& wanted);

}  // namespace scintray::mesh
