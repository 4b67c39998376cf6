#pragma once
/// Scenes made from files of other programs: mesh and CAD files, GDML.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "scintray/mesh/tessellation.hpp"
#include "scintray/mesh/trimesh.hpp"

namespace scintray::scene {
struct BuiltScene;
}

namespace scintray::exchange {

/// A scene file's text and the meshes that it names, not yet written.
struct SceneDraft {
  std::string toml;
  std::map<std::filesystem::path, mesh::TriMesh> meshes;  ///< by path from the scene's folder, .ply
  std::vector<std::string> notes;                         ///< what was not converted, or differs
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

/// Deviation of round solids, as a share of their radius, where it is more than that of all tessellations:
/// vessels of metres would have a million triangles at 0.01 mm (docs/decisions.md).
inline constexpr double kDeviationPerRadius = 1e-4;

struct GdmlImport {
  mesh::Tessellation tessellation{.deviation_per_radius = kDeviationPerRadius};
  std::map<std::string, std::string> media;     ///< database medium for a material of the file
  std::map<std::string, std::string> surfaces;  ///< database surface for an optical surface of the file
  bool skip_unsupported = false;      ///< leave out volumes whose solid is not supported, with a note
  std::filesystem::path mesh_folder;  ///< of the meshes, from the scene's folder
  /// Elements state the file, line and column that they were made from, in the attribute `origin`.
  bool stated_origins = false;
  std::vector<std::string> notes;  ///< what was not converted in earlier steps
  /// The example source lies in all copies of its volume, where a pattern names these and no other parts.
  bool light_in_all_copies = false;
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

/// The [media] and [surfaces] of all materials and optical surfaces of a file, without a scene around them.
SceneDraft definitions_of_gdml(const std::string& content, const std::string& file,
                               const GdmlImport& options);

/// A GDML document, and notes on what of the scene it does not hold, with the effect.
struct GdmlExport {
  std::string text;
  std::vector<std::string> notes;
};

/// A scene as a GDML document for Geant4 11: a tessellated solid for each part, nested as in the scene,
/// materials with their tables, compositions and densities, and border surfaces for light of each direction.
///
/// A sensor is a body of its window's index that holds one a thousandth smaller, whose surface absorbs all
/// light and has the efficiency as EFFICIENCY. Tables cover the wavelengths in use.
GdmlExport export_gdml(const scene::BuiltScene& scene);

}  // namespace scintray::exchange::gdml

namespace scintray::exchange::gate {

/// A scene of the detector that a macro of GATE 9 describes: boxes, cylinders, spheres and cones, their
/// placements and repeaters (cubicArray, linear, ring, genericRepeater), materials of GateMaterials.db with
/// the properties of Materials.xml, and surfaces of Surfaces.xml between volumes, for light of one direction.
/// The two .xml lie beside the macro, or in the folder above. The detector becomes the GDML document that
/// Geant4 would have, and the scene is made as by draft_of_gdml.
/// Throws InputError with all problems: file, line, and a hint.
SceneDraft draft_of_gate(const std::filesystem::path& macro, gdml::GdmlImport options);

/// The [media] of a Materials.xml, or the [surfaces] of a Surfaces.xml, of GATE 9 or 10.
SceneDraft definitions_of_gate(const std::filesystem::path& file, gdml::GdmlImport options);

}  // namespace scintray::exchange::gate
