#pragma once
/// The definitions that a scene names, and its own.

#include <map>
#include <vector>

#include "scintray/config/name_ref.hpp"
#include "scintray/config/toml_reader.hpp"
#include "scintray/core/error.hpp"
#include "scintray/materials/database.hpp"
#include "scintray/scene_file/spec.hpp"

namespace scintray::scene_file {

/// A name of a definition, with its kind and place.
struct DefinitionRef {
  materials::DefinitionKind kind;
  config::NameRef name;
};

/// The media, surfaces and sensors that parts, faces, contacts and goniometers name, each at its first place.
/// The medium kOpaqueMedium, which needs no definition, is left out.
std::vector<DefinitionRef> named_definitions(const SceneSpec& scene);

/// Reports every such name without a definition, shipped or in the scene. For scenes with other errors, whose
/// definitions are not read.
void expect_definitions(const SceneSpec& scene, core::Problems& problems);

/// A scene's own definitions, by kind and name.
std::vector<DefinitionRef> own_definitions(const SceneSpec& scene);

/// A scene's own definitions whose name is not a value in its file, of a part, a sweep or another definition,
/// in the order of the file. Values that name parts are not names of definitions.
std::vector<DefinitionRef> unused_definitions(const SceneSpec& scene, const config::TomlNode& document);

/// The table of a definition as the file has it: "surfaces.rough".
std::string definition_key(const DefinitionRef& definition);

}  // namespace scintray::scene_file
