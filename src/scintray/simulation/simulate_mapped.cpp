#include "scintray/simulation/response.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scintray/config/toml_reader.hpp"
#include "scintray/core/version.hpp"
#include "scintray/simulation/detail/map_shard.hpp"

namespace scintray::simulation {

namespace {

/// Keys of a scene that do not change the propagation of light to the sensors.
const std::vector<std::string> kFreeKeys = {"title", "source", "run",   "readout", "analysis",
                                            "tally", "claim",  "bench", "fit"};

/// Tolerance of a part's position relative to the map: the rounding of a scene's numbers.
constexpr double kSamePlace_mm = 1e-6;

void refuse_sweep(const scene_file::SceneFile& file) {
  if (file.points() != 1 || !file.sweep_keys().empty())
    throw core::InputError({{file.spec(0).file.string()},
                            "a response map is of one scene, and this one has a sweep",
                            "write a scene for each point, without [[sweep]]"});
}

void require_energy(const scene_file::SceneSpec& spec) {
  if (!spec.energy_source)
    throw core::InputError({spec.source.where,
                            "response maps are for event sources, and this is a source of photons",
                            "use type = \"gamma_events\", \"gammas\" or \"hits\" (docs/gamma_sources.md)"});
  if (std::holds_alternative<scene_file::PhotonListSpec>(spec.energy_source->kind))
    throw core::InputError({spec.energy_source->where,
                            "a response map is of scintillation light, and this is a list of photons",
                            "trace the scene with `scintray run`"});
  if (spec.energy_source->cherenkov)
    throw core::InputError(
        {spec.energy_source->where,
         "a response map is of scintillation light, and this source has Cherenkov light too",
         "remove cherenkov, or trace the scene with `scintray run`"});
}

/// A map describes the medium's light emitted at points: not light that depends on the particle, nor light
/// along steps.
void refuse_particles(const scene_file::SceneSpec& spec, const scene::Scene& scene) {
  const auto* hits = std::get_if<scene_file::HitsSpec>(&spec.energy_source->kind);
  const auto any = [](const auto& columns) {
    return std::any_of(columns.begin(), columns.end(), [](const auto& column) { return !column.empty(); });
  };
  if (hits && (any(hits->steps) || (hits->columns && any(hits->columns->steps))))
    throw core::InputError(
        {spec.energy_source->where,
         "a response map is of light from points, and these deposits are steps of particles",
         "trace the scene with `scintray run`, or leave the columns of steps out"});
  for (const scene::SceneMedium& medium : scene.media)
    if (!medium.medium().by_particle.empty())
      throw core::InputError({spec.energy_source->where,
                              "the light of medium \"" + medium.medium().name +
                                  "\" depends on the particle, which a response map does not hold",
                              "trace the scene with `scintray run`"});
}

/// Assigns to the grids of a map their regions in a scene.
void bind_grids(ResponseMap& map, const scene::Scene& scene, const std::string& where) {
  const auto changed = [&](const std::string& what) {
    return core::InputError(
        {{where},
         "this response map is of other parts: " + what,
         "a mesh or another file of the scene has changed since; build the map again with "
         "`scintray response build`"});
  };
  const tally::ReadoutChannels channels(scene);
  std::vector<std::string> names;
  for (const tally::ReadoutChannel& channel : channels.list) names.push_back(channel.name);
  if (names != map.channels) throw changed("its channels are not those of the scene");
  for (ResponseGrid& grid : map.grids) {
    const auto part = std::find_if(scene.parts.begin(), scene.parts.end(),
                                   [&](const scene::PartInfo& info) { return info.name == grid.part; });
    if (part == scene.parts.end()) throw changed("there is no part \"" + grid.part + "\" any more");
    const core::Vec3 high =
        grid.low + grid.pitch.cwiseProduct(core::Vec3(grid.cells[0], grid.cells[1], grid.cells[2]));
    if ((part->bounds.min() - grid.low).cwiseAbs().maxCoeff() > kSamePlace_mm ||
        (part->bounds.max() - high).cwiseAbs().maxCoeff() > kSamePlace_mm)
      throw changed("\"" + grid.part + "\" has another place or size");
    grid.region = part->region;
  }
}

bool counts_photons(const scene_file::SceneSpec& spec) {
  return !spec.tallies.empty() || spec.run.photon_list || spec.run.photon_history;
}

/// The options, changing every scene to one without the output that requires traced photons.
SimulationOptions without_photons(SimulationOptions options) {
  options.change = [change = std::move(options.change)](scene_file::SceneSpec& spec) {
    if (change) change(spec);
    spec.tallies.clear();
    spec.run.photon_list = spec.run.photon_history = false;
    spec.run.paths = 0;
  };
  return options;
}

/// All that the cells of a map depend on, as text.
std::string identity_of(const scene_file::SceneFile& file, const MapOptions& options, const RunOutline& run) {
  const ResponseSettings& s = options.settings;
  std::string text =
      fmt::format("response map\n{}\npitch {:.17g} photons {} delays {} direction {} photons {} seed {}\n",
                  run.header.version, s.pitch_mm, s.photons_per_cell, s.delays_kept,
                  core::word_of(kMapDirections, s.direction), s.photons_per_channel, run.header.seed);
  if (options.shard)
    text += fmt::format("shard {}/{}\n", options.shard->shard.number, options.shard->shard.of);
  for (const core::InputFile& input : run.inputs) text += input.name + " " + input.sha256 + "\n";
  return text + file.text();
}

std::string origin_note(const std::filesystem::path& path, const ResponseFile& response) {
  const ResponseMap& map = response.map;
  return "events from the response map " + path.filename().string() + " (ScintRay " + response.version +
         ", seed " + std::to_string(map.seed) + ", " +
         (map.backward() ? std::to_string(map.photons_per_channel) + " photons backward from each channel"
                         : std::to_string(map.photons_per_cell) + " photons in each cell") +
         "); no photon was traced for them";
}

}  // namespace

ResponseFile build_map(const scene_file::SceneFile& file, const MapOptions& options) {
  refuse_sweep(file);
  require_energy(file.spec(0));
  Simulation simulation(file, without_photons(options.simulation));
  const auto point = simulation.point(0);
  const scene_file::SceneSpec& spec = point->spec();
  std::optional<core::Journal> journal;
  ResponseHooks hooks = options.hooks;
  if (options.journal) {
    journal.emplace(*options.journal, identity_of(file, options, simulation.outline()));
    hooks.journal = &*journal;
  }
  std::optional<MapShardWriter> shard;
  if (options.shard) {
    const RunOutline outline = simulation.outline();
    shard.emplace(options.shard->path, options.shard->shard,
                  MapOrigin{core::version(), spec.file.string(), file.text(), outline.inputs});
    hooks.shard = &*shard;
  }
  ResponseFile built{
      build_response_map(point->scene(), point->source().regions(), spec.energy_source->unpolarised,
                         options.settings, point->settings(), hooks),
      core::version(), spec.file.string(), file.text()};
  if (shard && !built.map.grids.empty()) shard->commit();
  if (options.settings.direction == MapDirection::automatic && !built.map.backward())
    built.forward_because = why_not_backward(point->scene());
  return built;
}

void require_same_scene(const scene_file::SceneFile& file, const ResponseFile& response) {
  const scene_file::SceneSpec spec = file.spec(0);
  const std::string hint = "build the map again with `scintray response build`, or run the scene it is of";
  const std::string other =
      config::first_difference(*config::parse_toml(response.scene_text, response.scene_file),
                               *config::parse_toml(file.text(), spec.file.string()), kFreeKeys);
  if (!other.empty())
    throw core::InputError(
        {{spec.file.string()}, "the response map is of another scene: \"" + other + "\" differs", hint});
  if (spec.energy_source->unpolarised != response.map.unpolarised)
    throw core::InputError({spec.energy_source->where,
                            std::string("the response map is of ") +
                                (response.map.unpolarised ? "unpolarised" : "polarised") +
                                " light, in contradiction to source.polarisation",
                            hint});
}

tally::RunResult simulate_mapped(const scene_file::SceneFile& file, const std::filesystem::path& map_file,
                                 ResultSink& sink, const SimulationOptions& options,
                                 const SimulationHooks& hooks) {
  refuse_sweep(file);
  const scene_file::SceneSpec as_written = file.spec(0);
  require_energy(as_written);
  Simulation simulation(file, without_photons(options));
  simulation.spec(0);  // errors of the options come first
  ResponseFile response = read_response(map_file);
  require_same_scene(file, response);
  refuse_particles(simulation.spec(0), simulation.point(0)->scene());
  bind_grids(response.map, simulation.point(0)->scene(), map_file.string());
  RunOutline outline = simulation.outline();
  std::string& note = outline.header.note;
  note = origin_note(map_file, response) + (note.empty() ? "" : "\n") + note;
  if (counts_photons(as_written)) note += "\ntallies, the list of photons and their histories are left out";

  tally::RunResult result;
  result.header = outline.header;
  sink.begin(outline);
  result.points.push_back(simulation.run(0, MappedResponse(response.map), sink, hooks));
  if (!result.complete()) result.partial_reason = kStopped;
  sink.commit(result.complete(), result.partial_reason);
  return result;
}

}  // namespace scintray::simulation
