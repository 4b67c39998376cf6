#pragma once
/// A GDML file as a scene.

#include <filesystem>
#include <map>
#include <string>

#include "scintray/exchange/scene_draft.hpp"

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
