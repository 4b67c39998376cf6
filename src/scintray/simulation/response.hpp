#pragma once
/// Response maps of scene files: built, kept in files (HDF5, docs/response_maps.md), and events from them.

#include <filesystem>
#include <string>

#include "scintray/simulation/response_map.hpp"
#include "scintray/simulation/simulation.hpp"

namespace scintray::simulation {

/// Version of the file's layout; grows when a reader of the older one would misread the newer.
inline constexpr std::int64_t kResponseVersion = 1;

/// A map and where it comes from.
struct ResponseFile {
  ResponseMap map;         ///< as read, grids know their parts and not their regions
  std::string version;     ///< of ScintRay
  std::string scene_file;  ///< as it was named
  std::string scene_text;  ///< the whole scene file
};

/// Throws InputError when `path` is taken by something that is not a response map, SystemError when it cannot
/// be written.
void write_response(const std::filesystem::path& path, const ResponseFile& file);

/// Throws what write_response would before anything is traced for it.
void check_response_path(const std::filesystem::path& path);

/// Throws InputError when the file is missing, is not a response map, has a version this program does not
/// read or contradicts itself.
ResponseFile read_response(const std::filesystem::path& path);

struct MapOptions {
  ResponseSettings settings;
  std::optional<int> threads;  ///< in place of the scene's
  std::optional<std::uint64_t> seed;
  ResponseHooks hooks;
  materials::SurfaceFactory::Hooks surface_hooks;  ///< called while surface tables are built
  const mesh::MeshFormats* mesh_formats = &mesh::MeshFormats::built_in();  ///< as SimulationOptions has them
};

/// Builds the map of all parts that scintillate. The scene's [source] states whether light is polarised and,
/// by being one of energy, which wavelengths are in use; its events are not requested.
/// @return without grids when stopped
/// @throws InputError for a scene with a sweep or a source of photons, and as build_response_map does
ResponseFile build_map(const scene_file::SceneFile& file, const MapOptions& options);

/// Throws InputError unless the scene is the one that the map is of: everything must be written alike but
/// the title, [source], [run], [readout], [analysis] and tallies, and light must be polarised or not as then.
void require_same_scene(const scene_file::SceneFile& file, const ResponseFile& response);

/// Events of the scene from a map, as Simulation::run_all makes them by tracing. The header states in its
/// note where they come from. Tallies of photons are left out, as no photon is traced.
/// @throws InputError as require_same_scene does, and when parts are not where they were
tally::RunResult simulate_mapped(const scene_file::SceneFile& file, const std::filesystem::path& map_file,
                                 ResultSink& sink, const SimulationOptions& options,
                                 const SimulationHooks& hooks = {});

}  // namespace scintray::simulation
