#pragma once
/// COLLADA, read here: assimp up to 5.3 reads beyond its arrays when a file's counts do not fit each other.

#include <filesystem>
#include <string>

#include "scintray/mesh/import/detail/raw_mesh.hpp"

namespace scintray::mesh {

/// Reads COLLADA content (1.4.1, 1.5: Khronos Group, "COLLADA - Digital Asset Schema"): the meshes that the
/// visual scene places, with the transforms of its nodes, in the file's own axes and unit (<asset><unit
/// meter="..."/>; one metre when it is left out). Triangles, polylists, polygons, strips and fans; skins
/// unposed, with a note. Bodies are placed geometries, called after their node; groups are geometry and
/// material. Throws InputError for malformed files, references that lead nowhere, nodes inside themselves,
/// holes in polygons, and instances that multiply to more than 20 million triangles.
RawMesh import_collada(const std::filesystem::path& path, const std::string& content);

}  // namespace scintray::mesh
