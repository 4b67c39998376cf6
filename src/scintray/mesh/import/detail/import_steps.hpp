#pragma once
/// What the import does with the mesh that the reader of a format returned.

#include <filesystem>
#include <string>
#include <vector>

#include "scintray/mesh/import/raw_mesh.hpp"

namespace scintray::mesh {

/// What coordinates have to be multiplied with to be mm. `given_mm` is the unit that the user states, 0 for
/// none. Adds a note when it replaces the unit that the format prescribes. Throws InputError when nobody
/// states a unit, and when the user's contradicts what the file itself states.
double resolve_unit(const std::filesystem::path& path, double given_mm, const FileUnit& unit,
                    std::vector<std::string>& notes);

/// Keeps the body called `wanted`, or with that number from 1 on, with the vertices and groups that it uses.
/// Empty takes all bodies together, with a note when they are several. Throws InputError, naming the bodies
/// there are, when none fits.
void choose_body(const std::filesystem::path& path, RawMesh& raw, const std::string& wanted);

}  // namespace scintray::mesh
