#pragma once
/// Everything with a body in a scene file.

#include <string>
#include <vector>

#include "scintray/scene_file/contact.hpp"
#include "scintray/scene_file/part.hpp"

namespace scintray::scene_file {

/// Everything with a body: [[part]], [[array]], [[light_guide]], in file order.
struct Bodies {
  std::vector<PartSpec> parts;
  std::vector<GroupSpec> groups;
  std::vector<ContactSpec> contacts;  ///< that builders make with their parts
  InlineTables surfaces;              ///< that builders make for their sheets
  bool names_known = true;            ///< false when mistakes left a builder's parts unknown
};

/// Reads all bodies and checks their names against each other.
Bodies read_bodies(const config::TomlTable& scene);

/// Names of all parts, the fills that placements make included, in file order.
std::vector<std::string> part_names(const std::vector<PartSpec>& parts, const std::vector<GroupSpec>& groups);

}  // namespace scintray::scene_file
