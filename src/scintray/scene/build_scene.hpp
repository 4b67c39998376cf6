#pragma once
/// Construction of the scene for transport from the specification of a scene file.

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scintray/materials/database.hpp"
#include "scintray/materials/surface_factory.hpp"
#include "scintray/mesh/diagnosis.hpp"
#include "scintray/scene/place_parts.hpp"
#include "scintray/scene/scene.hpp"
#include "scintray/scene_file/spec.hpp"

namespace scintray::scene {

/// Report on one part by `scintray check`.
struct PartReport {
  std::string name;
  mesh::MeshDiagnosis diagnosis;
  std::vector<std::string> notes;
};

struct BuiltScene {
  Scene scene;
  std::vector<PartReport> parts;
  std::vector<contact::PlacedMesh> placed;  ///< the parts in the scene, cut and conformed
  std::vector<std::string> warnings;        ///< none of which stops a run
};

/// Builder of scenes. Surfaces made for one are kept for the next, so that a sweep traces each table once;
/// definitions are read once (MaterialDatabase).
class SceneBuilder {
 public:
  /// @param models   surface and sensor models that definitions may name
  /// @param formats  formats of the mesh files of parts; must outlive the builder
  explicit SceneBuilder(materials::SurfaceFactory::Hooks hooks = {}, materials::DefinitionModels models = {},
                        const mesh::MeshFormats& formats = mesh::MeshFormats::built_in());

  /// Throws InputError with every problem: unsound meshes, faces without or with two surfaces,
  /// overlaps, unknown names, media without an index at the wavelengths in use, sensors that no light
  /// can reach.
  BuiltScene build(const scene_file::SceneSpec& spec);
  /// True when the scene built from `of` is also that of `spec`: the two differ at most in their source, run
  /// settings, tallies and analysis, and the light of both sources has the same wavelengths. False where
  /// building `spec` would throw.
  bool serves(const BuiltScene& built, const scene_file::SceneSpec& of, const scene_file::SceneSpec& spec);

  /// The factory that makes and keeps its surfaces.
  materials::SurfaceFactory& surfaces() { return surface_factory_; }
  /// The shipped database with a scene's own definitions. Valid until the next scene with other definitions.
  const materials::MaterialDatabase& database(const scene_file::SceneSpec& spec);
  /// Numbers of files and definitions read for all scenes so far.
  materials::MaterialDatabase::Readings readings() const;

 private:
  using OwnDefinitions = std::array<scene_file::InlineTables, 4>;  ///< media, surfaces, sensors, reflectors

  materials::SurfaceFactory surface_factory_;
  materials::DefinitionModels models_;
  const mesh::MeshFormats* formats_;
  std::optional<materials::MaterialDatabase> shipped_, database_;
  OwnDefinitions own_;  ///< of `database_`
};

/// Adds a scene's own media, surfaces, sensors and reflectors to a material database.
void add_definitions(materials::MaterialDatabase& database, const scene_file::SceneSpec& spec);
/// The shipped material database with a scene's own definitions.
materials::MaterialDatabase database_for(const scene_file::SceneSpec& spec);

}  // namespace scintray::scene
