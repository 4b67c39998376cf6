#pragma once
/// The unit that a mesh file states, and what becomes of it when the user states one as well.

#include <filesystem>
#include <string>
#include <vector>

#include "scintray/mesh/raw_mesh.hpp"

namespace scintray {

/// <asset><unit meter="..." name="..."/> of a COLLADA file (COLLADA 1.5 specification, section 5, "unit": one
/// metre when it is left out); assimp has turned the coordinates into metres. Throws InputError for XML that
/// cannot be read or a length that is not positive.
FileUnit read_collada_unit(const std::filesystem::path& path, const std::string& content);

/// What coordinates have to be multiplied with to be mm. `given_mm` is the unit that the user states, 0 for
/// none. Adds a note when it replaces the unit that the format prescribes. Throws InputError when nobody
/// states a unit, and when the user's contradicts what the file itself says.
double resolve_unit(const std::filesystem::path& path, double given_mm, const FileUnit& unit,
                    std::vector<std::string>& notes);

}  // namespace scintray
