#pragma once
/// The unit that a mesh file states, and what becomes of it when the user states one as well.

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

}  // namespace scintray::mesh
