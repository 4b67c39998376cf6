#pragma once
/// 3MF, read here: assimp up to 5.3 aborts the process for archives that do not fit their checksums or whose
/// relationships lead nowhere, and frees their pictures twice.

#include <filesystem>
#include <string>

#include "scintray/mesh/import/detail/raw_mesh.hpp"

namespace scintray::mesh {

/// Reads a 3MF archive (3MF Core Specification 1.3): the model that the relationships name, its meshes and
/// components as its build items place them, in the unit of the model. Coordinates keep double precision.
/// Bodies are build items, called after their object; groups are object and base material. Colours, textures
/// and the extensions for slices and lattices are not looked at. Throws InputError when malformed, when
/// objects are made of themselves, and when components multiply to more than 20 million triangles.
RawMesh import_3mf(const std::filesystem::path& path, const std::string& content);

}  // namespace scintray::mesh
