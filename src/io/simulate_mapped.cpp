#include "scintray/io/simulate_mapped.hpp"

#include <algorithm>

#include "scintray/core/version.hpp"
#include "scintray/io/results.hpp"
#include "scintray/scene/scene_difference.hpp"
#include "scintray/trace/light_timing.hpp"
#include "scintray/trace/run_mapped.hpp"

namespace scintray {

namespace {

/// Keys of a scene that do not change how light goes from a place to a sensor.
const std::vector<std::string> kFreeKeys = {"title", "source", "run",   "readout", "analysis",
                                            "tally", "claim",  "bench", "fit"};

/// How far a part may be from where the map has it: what rounding of a scene's numbers makes.
constexpr double kSamePlace_mm = 1e-6;

void refuse_sweep(const SceneFile& file) {
  if (file.points() != 1 || !file.sweep_keys().empty())
    throw InputError({{file.spec(0).file.string()},
                      "a response map is of one scene, and this one has a sweep",
                      "make a scene of each point, without [[sweep]]"});
}

void require_energy(const SceneSpec& spec) {
  if (!spec.energy_source)
    throw InputError({spec.source.where,
                      "response maps are for sources of energy, and this is a source of photons",
                      "use type = \"gamma_events\", \"gammas\" or \"hits\" (docs/gamma_sources.md)"});
  if (spec.energy_source->cherenkov)
    throw InputError({spec.energy_source->where,
                      "a response map is of scintillation light, and this source has Cherenkov light too",
                      "remove cherenkov, or trace the scene with `scintray run`"});
}

/// Gives the grids of a map their regions of a scene.
void bind_grids(ResponseMap& map, const Scene& scene, const std::string& where) {
  const auto changed = [&](const std::string& what) {
    return InputError({{where},
                       "this response map is of other parts: " + what,
                       "a mesh or another file of the scene has changed since; build the map again with "
                       "`scintray response build`"});
  };
  const ReadoutChannels channels(scene);
  std::vector<std::string> names;
  for (const ReadoutChannel& channel : channels.list) names.push_back(channel.name);
  if (names != map.channels) throw changed("its channels are not those of the scene");
  for (ResponseGrid& grid : map.grids) {
    const auto part = std::find_if(scene.parts.begin(), scene.parts.end(),
                                   [&](const PartInfo& info) { return info.name == grid.part; });
    if (part == scene.parts.end()) throw changed("there is no part \"" + grid.part + "\" any more");
    const Vec3 high = grid.low + grid.pitch.cwiseProduct(Vec3(grid.cells[0], grid.cells[1], grid.cells[2]));
    if ((part->bounds.min() - grid.low).cwiseAbs().maxCoeff() > kSamePlace_mm ||
        (part->bounds.max() - high).cwiseAbs().maxCoeff() > kSamePlace_mm)
      throw changed("\"" + grid.part + "\" has another place or size");
    grid.region = part->region;
  }
}

RunHeader mapped_header(const SceneFile& file, const SceneSpec& spec, const Scene& scene,
                        const std::vector<std::string>& notes) {
  RunHeader header;
  header.title = spec.title;
  header.version = version();
  header.scene_file = spec.file.string();
  header.scene_text = file.text();
  header.seed = spec.run.seed;
  for (const SceneMedium& medium : scene.media) header.media.push_back(medium.medium().name);
  for (const Surface& surface : scene.surfaces) header.surfaces.push_back(surface.name);
  for (const PartInfo& part : scene.parts) header.parts.push_back(part.name);
  for (const FaceInfo& face : scene.faces) header.faces.push_back(face.name);
  for (const std::string& note : notes) header.note += (header.note.empty() ? "" : "\n") + note;
  return header;
}

std::string origin_note(const std::filesystem::path& path, const ResponseFile& response) {
  const ResponseMap& map = response.map;
  return "events from the response map " + path.filename().string() + " (ScintRay " + response.version +
         ", seed " + std::to_string(map.seed) + ", " + std::to_string(map.photons_per_cell) +
         " photons in each cell); no photon was traced for them";
}

}  // namespace

ResponseFile build_map(const SceneFile& file, const MapOptions& options) {
  refuse_sweep(file);
  SceneSpec spec = file.spec(0);
  require_energy(spec);
  if (options.threads) spec.run.threads = options.threads;
  if (options.seed) spec.run.seed = *options.seed;
  SceneBuilder builder(options.surface_hooks);
  const BuiltScene built = builder.build(spec);
  const auto source = make_light_source(spec, built.scene);
  return {build_response_map(built.scene, source->regions(), spec.energy_source->unpolarised,
                             options.settings, run_settings(spec.run), options.hooks),
          version(), spec.file.string(), file.text()};
}

void require_same_scene(const SceneFile& file, const ResponseFile& response) {
  const SceneSpec spec = file.spec(0);
  const std::string hint = "build the map again with `scintray response build`, or run the scene it is of";
  const std::string other = first_difference(*parse_toml(response.scene_text, response.scene_file),
                                             *parse_toml(file.text(), spec.file.string()), kFreeKeys);
  if (!other.empty())
    throw InputError(
        {{spec.file.string()}, "the response map is of another scene: \"" + other + "\" differs", hint});
  if (spec.energy_source->unpolarised != response.map.unpolarised)
    throw InputError({spec.energy_source->where,
                      std::string("the response map is of ") +
                          (response.map.unpolarised ? "unpolarised" : "polarised") +
                          " light, and source.polarisation says otherwise",
                      hint});
}

RunResult simulate_mapped(const SceneFile& file, const std::filesystem::path& map_file,
                          const SimulationOptions& options) {
  refuse_sweep(file);
  SceneSpec spec = file.spec(0);
  require_energy(spec);
  spec = with_options(spec, options);
  ResponseFile response = read_response(map_file);
  require_same_scene(file, response);
  SceneBuilder builder(options.surface_hooks);
  const BuiltScene built = builder.build(spec);
  bind_grids(response.map, built.scene, map_file.string());
  std::vector<std::string> notes{origin_note(map_file, response)};
  notes.insert(notes.end(), built.warnings.begin(), built.warnings.end());
  const auto source = make_light_source(spec, built.scene, &notes);
  if (!spec.tallies.empty() || !spec.exit_angles.empty() || spec.run.photon_list || spec.run.photon_history)
    notes.emplace_back("tallies, the list of photons and their histories are left out");
  spec.tallies.clear();
  spec.exit_angles.clear();
  spec.run.photon_list = spec.run.photon_history = false;
  const TallyPlan plan(built.scene, spec);

  RunResult result;
  result.header = mapped_header(file, spec, built.scene, notes);
  ResultsWriter writer(options.output, result.header, false);
  writer.begin_events(0, plan.channels.list, spec.readout);
  RunHooks hooks;
  hooks.stop = options.stop;
  hooks.events = [&](const std::vector<EventRecord>& events) { writer.append_events(events); };
  SimulationProgress progress;
  progress.thing = "events";
  progress.total = source->events();
  hooks.progress = [&](std::uint64_t done) {
    progress.done = done;
    if (options.progress) options.progress(progress);
  };
  const MappedResponse mapped(response.map);
  result.points.push_back(run_mapped(built.scene, *source, plan, mapped, run_settings(spec.run), hooks));
  result.points.back().light_timing = light_timing(built.scene, spec, *source, plan);
  writer.add_point(result.points.back());
  writer.commit(result.complete(), result.complete() ? "" : "stopped by the user");
  return result;
}

}  // namespace scintray
