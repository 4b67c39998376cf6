#pragma once
/// Taking one body out of a file that holds several.

#include <filesystem>
#include <string>

#include "scintray/mesh/import/raw_mesh.hpp"

namespace scintray::mesh {

/// Keeps the body called `wanted`, or with that number from 1 on, with the vertices and groups that it uses.
/// Empty takes all bodies together, with a note when they are several. Throws InputError, naming the bodies
/// there are, when none fits.
void choose_body(const std::filesystem::path& path, RawMesh& raw, const std::string& wanted);

}  // namespace scintray::mesh
