#pragma once
/// Scenes made from files of other programs: mesh and CAD files, GDML.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "scintray/mesh/tessellation.hpp"
#include "scintray/mesh/trimesh.hpp"

namespace scintray::exchange {

/// A scene file's text and the meshes that it names, not yet written.
struct SceneDraft {
  std::string toml;
  std::map<std::filesystem::path, mesh::TriMesh> meshes;  ///< by path from the scene's folder, .ply
  std::vector<std::string> notes;                         ///< what was not carried over
  std::vector<std::string> missing;  ///< what the user must fill in before the scene runs
};

/// Where the draft is to go: a scene file that ends in .toml, or a folder, whose scene.toml it becomes.
std::filesystem::path scene_file_of(const std::filesystem::path& output);

/// Writes the meshes, then the scene; folders are made. @throws InputError when the scene file is there
/// already; SystemError when something cannot be written.
void write_scene_draft(const SceneDraft& draft, const std::filesystem::path& scene_file);

/// A TOML string, with its quotes.
std::string toml_string(const std::string& text);

/// A name that a part may have: dots, colons, quotes and white space become _.
std::string part_name(const std::string& name);

/// What the other program's file leaves open, when a model file becomes a scene.
struct ModelImport {
  std::string unit;  ///< as "mm"; empty: the file's own
  mesh::Tessellation tessellation;
  std::filesystem::path path_in_scene;  ///< how the scene names the file
};

/// A scene with one part for each body of a mesh or CAD file. Media and surfaces are not in such files: the
/// parts have none, and the scene is refused until they are filled in. Throws what import_mesh throws.
SceneDraft draft_of_model(const std::filesystem::path& file, const ModelImport& options);

}  // namespace scintray::exchange

namespace scintray::exchange::gdml {

struct GdmlImport {
  mesh::Tessellation tessellation;
  std::map<std::string, std::string> media;     ///< library medium for a material of the file
  std::map<std::string, std::string> surfaces;  ///< library surface for an optical surface of the file
  bool skip_unsupported = false;                ///< leave out volumes whose solid cannot be made, with a note
  std::filesystem::path mesh_folder;            ///< of the meshes, from the scene's folder
};

/// The whole detector of a GDML file: a part for each placed volume, the world's material around it, its
/// materials as media, its optical surfaces as surfaces.
///
/// A material without RINDEX is opaque, as in Geant4. Skin surfaces become the surface of the parts of their
/// volume, and of the daughters that have none; a border from a daughter into its mother the surface of the
/// daughter; a border between two volumes of one mother a bonded contact. Light starts, as an example, in
/// the first part that scintillates, else in the first that is transparent.
/// Throws InputError for what GdmlFile, Definitions, Solids, the materials and the structure refuse.
SceneDraft draft_of_gdml(const std::string& content, const std::string& file, const GdmlImport& options);

}  // namespace scintray::exchange::gdml
