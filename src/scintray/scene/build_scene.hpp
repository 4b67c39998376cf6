#pragma once
/// From what a scene file states to the scene that photons see.

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

/// What `scintray check` states of one part beyond the scene itself.
struct PartReport {
  std::string name;
  mesh::MeshDiagnosis diagnosis;
  std::vector<std::string> notes;
};

struct BuiltScene {
  Scene scene;
  std::vector<PartReport> parts;
  std::vector<contact::PlacedMesh> placed;  ///< the parts as they are in the scene, cut and conformed
  std::vector<std::string> warnings;        ///< things a user should know, none of which stops a run
};

/// Builds scenes. Surfaces made for one are kept for the next, so a sweep traces each table once; definitions
/// of the material database are read once (Library).
class SceneBuilder {
 public:
  /// @param formats  that mesh files of parts may have; must outlive the builder
  explicit SceneBuilder(materials::SurfaceFactory::Hooks hooks = {},
                        const mesh::MeshFormats& formats = mesh::MeshFormats::built_in());

  /// Throws InputError with every problem: unsound meshes, faces without or with two surfaces,
  /// overlaps, unknown names, media without an index at the wavelengths in use, sensors that no light
  /// can reach.
  BuiltScene build(const scene_file::SceneSpec& spec);

  /// What makes its surfaces, and keeps them.
  materials::SurfaceFactory& surfaces() { return surface_factory_; }
  /// The shipped database with a scene's own definitions. Lives until the next scene whose own are others.
  const materials::MaterialDatabase& database(const scene_file::SceneSpec& spec);
  /// How often files and definitions were read for all scenes so far.
  materials::MaterialDatabase::Readings readings() const;

 private:
  using OwnDefinitions = std::array<scene_file::InlineTables, 4>;  ///< media, surfaces, sensors, reflectors

  materials::SurfaceFactory surface_factory_;
  const mesh::MeshFormats* formats_;
  std::optional<materials::MaterialDatabase> shipped_, database_;
  OwnDefinitions own_;  ///< of `database_`
};

/// Adds a scene's own media, surfaces, sensors and reflectors to a library.
void add_definitions(materials::MaterialDatabase& database, const scene_file::SceneSpec& spec);
/// The shipped database with them.
materials::MaterialDatabase database_for(const scene_file::SceneSpec& spec);

}  // namespace scintray::scene
