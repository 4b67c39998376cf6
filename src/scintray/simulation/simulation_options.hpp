#pragma once
/// Options of a simulation that are not in the scene.

#include <cstdint>
#include <functional>
#include <optional>

#include "scintray/materials/database.hpp"
#include "scintray/materials/surface_factory.hpp"
#include "scintray/mesh/import/mesh_format.hpp"
#include "scintray/scene_file/read_scene.hpp"
#include "scintray/scene_file/spec.hpp"
#include "scintray/simulation/run_point.hpp"

namespace scintray::simulation {

struct SimulationOptions {
  std::optional<int> threads;     ///< replaces the scene's
  std::optional<int> lane_width;  ///< photons propagated at once; no result depends on it
  std::optional<std::uint64_t> seed;
  std::optional<std::uint64_t> photons;  ///< per point, of a source of photons
  std::optional<std::uint64_t> events;   ///< per point, of an event source
  bool quick = false;  ///< the scene's quick_photons or quick_events in place of its full number
  std::function<void(scene_file::SceneSpec&)>
      change;                                      ///< applied to the scene of every point, after all others
  materials::SurfaceFactory::Hooks surface_hooks;  ///< called while surface tables are built
  materials::DefinitionModels models;              ///< surface and sensor models that the scene may name
  /// Formats of the mesh files of parts; must outlive the simulation. Null: those that the scene file was
  /// read with (scene_file::Extensions), which elements of arrays need, since their size is needed then;
  /// built-in ones for a scene that is no file.
  const mesh::MeshFormats* mesh_formats = nullptr;
  /// Points of a sweep are kept from when they are built until they have been traced, as long as the parts of
  /// their scenes, each scene counted once, have no more triangles than this: a block of 12 x 12 crystals
  /// takes 3 MB. Of the scenes beyond only the latest is kept, and the others are built again when they are
  /// traced.
  std::size_t most_triangles_kept = 2'000'000;
};

/// A scene with the options in place of its own settings.
/// @throws InputError for an option that the scene's source does not have
scene_file::SceneSpec with_options(scene_file::SceneSpec spec, const SimulationOptions& options);

/// Formats of the mesh files of a scene's parts. @param file  null for a scene that is no file
const mesh::MeshFormats& mesh_formats_of(const SimulationOptions& options, const scene_file::SceneFile* file);

/// Settings of the tracer from [run].
/// @param point  of a sweep: each has random streams of its own
RunSettings run_settings(const scene_file::RunSpec& run, std::uint32_t point = 0);

}  // namespace scintray::simulation
