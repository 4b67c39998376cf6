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
  std::vector<std::string> notes;                         ///< what was not carried over, or differs
  std::string size;                  ///< of all bodies together, "3 x 3 x 20 mm"; may be empty
  std::vector<std::string> missing;  ///< what the user must fill in before the scene runs
};

/// Path of the draft's scene file: `output` when it ends in .toml, else scene.toml in that folder.
std::filesystem::path scene_file_of(const std::filesystem::path& output);

/// Writes the meshes, then the scene; folders are created. @throws InputError when the scene file exists
/// already; SystemError when something cannot be written.
void write_scene_draft(const SceneDraft& draft, const std::filesystem::path& scene_file);

/// A TOML string, with its quotes.
std::string toml_string(const std::string& text);

/// A valid name of a part: dots, colons, quotes and white space become _.
std::string part_name(const std::string& name);

/// Options of a scene from a model file: quantities that the file does not contain.
struct ModelImport {
  std::string unit;  ///< such as "mm"; empty: the file's own
  mesh::Tessellation tessellation;
  std::filesystem::path path_in_scene;  ///< path of the file in the scene
};

/// A scene with one part for each body of a mesh or CAD file. Media and surfaces are not in such files: the
/// parts have none, and the scene is invalid until they are filled in. Throws as import_mesh.
SceneDraft draft_of_model(const std::filesystem::path& file, const ModelImport& options);

}  // namespace scintray::exchange

namespace scintray::exchange::gdml {

struct GdmlImport {
  mesh::Tessellation tessellation;
  std::map<std::string, std::string> media;     ///< database medium for a material of the file
  std::map<std::string, std::string> surfaces;  ///< database surface for an optical surface of the file
  bool skip_unsupported = false;      ///< leave out volumes whose solid is not supported, with a note
  std::filesystem::path mesh_folder;  ///< of the meshes, from the scene's folder
};

/// A scene of the whole detector of a GDML file: a part for each placed volume, the world's material around
/// it, its materials as media, its optical surfaces as surfaces.
///
/// A material without RINDEX is opaque, as in Geant4. Skin surfaces become the surface of the parts of their
/// volume; borders become contacts, each with the surface of its direction; all contacts follow Geant4's rule
/// (ContactKind::each_side). The EFFICIENCY of a surface makes a sensor of its volume. Light starts, as an
/// example, in the first part that scintillates and is no sensor, else in the first that is transparent.
/// Throws InputError as GdmlFile, Definitions, Solids, the materials and the structure.
SceneDraft draft_of_gdml(const std::string& content, const std::string& file, const GdmlImport& options);

}  // namespace scintray::exchange::gdml
