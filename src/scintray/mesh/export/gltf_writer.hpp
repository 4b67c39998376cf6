#pragma once
/// Export to glTF 2.0, by tinygltf.

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scintray/mesh/trimesh.hpp"

namespace scintray::mesh {

/// A mesh with a name in a glTF file.
struct GltfObject {
  std::string name;
  const TriMesh* mesh = nullptr;
  /// Red, green, blue and opacity, 0 to 1, of all its triangles. Empty: grey.
  std::optional<std::array<double, 4>> colour;
};

/// Orientation of the axes of a file.
enum class GltfAxes {
  as_they_are,  ///< for meshes that are read again: importers of parts do not change axes
  z_up,         ///< for pictures: a node rotates z to glTF's y, which viewers show upwards
};

/// Writes a binary glTF file (.glb), completely or not at all: one node for each object, one primitive for
/// each group, coordinates in metres and single precision (sections 3.4 and 3.6.2 of the
/// specification). A group's material has its name, and its tags as extras (section 3.3), so that an import
/// restores groups and tags; groups of the same name, tags and colour share a material.
/// @throws SystemError when the file cannot be written
void write_glb(const std::filesystem::path& path, const std::vector<GltfObject>& objects, GltfAxes axes);

}  // namespace scintray::mesh
