#pragma once
/// The bodies of a scene file.

#include <string>
#include <vector>

#include "scintray/mesh/import/mesh_format.hpp"
#include "scintray/scene_file/contact.hpp"
#include "scintray/scene_file/part.hpp"

namespace scintray::scene_file {

/// The bodies of a scene: [[part]], [[array]], [[light_guide]], in file order.
struct Bodies {
  std::vector<PartSpec> parts;
  std::vector<GroupSpec> groups;
  std::vector<ContactSpec> contacts;  ///< made by builders with their parts
  InlineTables surfaces;              ///< made by builders for their sheets
  bool names_known = true;            ///< false when a builder's parts are not available because of errors
};

/// Reads all bodies and checks their names against each other.
/// @param formats  of mesh files
Bodies read_bodies(const config::TomlTable& scene,
                   const mesh::MeshFormats& formats = mesh::MeshFormats::built_in());

/// Names of all parts, those that fill gaps of placements included, in file order.
std::vector<std::string> part_names(const std::vector<PartSpec>& parts, const std::vector<GroupSpec>& groups);

}  // namespace scintray::scene_file
