#pragma once
/// Response maps of scene files: construction, files (HDF5, docs/response_maps.md), and events from them.

#include <filesystem>
#include <optional>
#include <string>

#include "scintray/simulation/range_file.hpp"
#include "scintray/simulation/response_map.hpp"
#include "scintray/simulation/simulation.hpp"

namespace scintray::simulation {

/// Version of the file's layout; grows when a reader of the older one would misread the newer.
inline constexpr std::int64_t kResponseVersion = 2;

/// A map and its origin.
struct ResponseFile {
  ResponseMap map;         ///< as read, grids have their parts but not their regions
  std::string version;     ///< of ScintRay
  std::string scene_file;  ///< name as given
  std::string scene_text;  ///< the complete scene file
  /// Of a map just built with MapDirection::automatic: why it was traced forward; not in the file.
  std::string forward_because = {};
};

/// Writes a map. Throws InputError when `path` is taken by a file that is not a response map, SystemError
/// when it cannot be written.
void write_response(const std::filesystem::path& path, const ResponseFile& file);

/// Throws as write_response would, before anything is traced.
void check_response_path(const std::filesystem::path& path);

/// Map of a file. Throws InputError when the file is missing, is not a response map, has a version this
/// program does not read or is inconsistent.
ResponseFile read_response(const std::filesystem::path& path);

/// A part of a map, as a file.
struct MapShard {
  std::filesystem::path path;
  Shard shard;
};

struct MapOptions {
  ResponseSettings settings;
  ResponseHooks hooks;
  SimulationOptions simulation;
  /// Keeps the finished cells, and has those of before. Its file is for the caller to remove, once the map is
  /// written.
  std::optional<core::JournalSettings> journal = {};
  std::optional<MapShard> shard = {};  ///< computes and writes this part, and not the map
};

/// Map of all parts that scintillate. The scene's [source] states whether light is polarised and, as an event
/// source, which wavelengths are in use; its events are not traced.
/// @return a map without grids when stopped; with a shard, one whose grids have no counts
/// @throws InputError for a scene with a sweep or a source of photons, and as build_response_map and
///         core::Journal do
ResponseFile build_map(const scene_file::SceneFile& file, const MapOptions& options);

/// True for a file that begins as a shard of a map does.
bool is_map_shard(const std::filesystem::path& path);

/// The map of which files are all shards, whatever their order: that which build_map makes in one process,
/// bit for bit.
/// @throws InputError for files that are damaged, of another map than the first, or that hold the same cells,
///         with each of them; and for missing shards, with their numbers: a map requires all its cells
ResponseFile merge_map_shards(const std::vector<std::filesystem::path>& files);

/// Throws InputError unless the scene is that of the map: everything must be written alike except the title,
/// [source], [run], [readout], [analysis] and tallies, and the polarisation of light must be the same.
void require_same_scene(const scene_file::SceneFile& file, const ResponseFile& response);

/// Events of the scene from a map, as Simulation::run_all produces them by tracing. The note of the header
/// states their origin. Tallies of photons are left out, as no photon is traced.
/// @throws InputError as require_same_scene, and when parts are not at their positions in the map
tally::RunResult simulate_mapped(const scene_file::SceneFile& file, const std::filesystem::path& map_file,
                                 ResultSink& sink, const SimulationOptions& options,
                                 const SimulationHooks& hooks = {});

}  // namespace scintray::simulation
