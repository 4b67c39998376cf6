#include "scintray/simulation/simulation_options.hpp"

namespace scintray::simulation {

RunSettings run_settings(const scene_file::RunSpec& run, std::uint32_t point) {
  RunSettings settings;
  settings.seed = run.seed;
  settings.point = point;
  settings.max_interactions = run.max_interactions;
  settings.max_time_ns = run.max_time_ns;
  settings.threads = run.threads.value_or(0);
  if (run.lane_width) settings.lane_width = *run.lane_width;
  return settings;
}

const mesh::MeshFormats& mesh_formats_of(const SimulationOptions& options,
                                         const scene_file::SceneFile* file) {
  if (options.mesh_formats) return *options.mesh_formats;
  return file ? file->extensions().mesh_formats : mesh::MeshFormats::built_in();
}

scene_file::SceneSpec with_options(scene_file::SceneSpec spec, const SimulationOptions& options) {
  if (options.threads) spec.run.threads = options.threads;
  if (options.lane_width) spec.run.lane_width = options.lane_width;
  if (options.seed) spec.run.seed = *options.seed;
  const auto refuse = [&](const char* option, const char* source, const char* other) {
    throw core::InputError({spec.energy_source ? spec.energy_source->where : spec.source.where,
                            std::string(option) + " is given, but this is a source of " + source,
                            std::string("use ") + other});
  };
  if (options.quick) {
    const auto& number = spec.energy_source ? spec.energy_source->quick_events : spec.source.quick_photons;
    const std::string key = spec.energy_source ? "quick_events" : "quick_photons";
    if (!number)
      throw core::InputError({spec.energy_source ? spec.energy_source->where : spec.source.where,
                              "--quick is given, but [source] has no " + key, "add " + key + " = ... there"});
    (spec.energy_source ? spec.energy_source->events : spec.source.photons) = *number;
  }
  if (options.photons) {
    if (spec.energy_source) refuse("--photons", "events", "--events");
    spec.source.photons = *options.photons;
  }
  if (options.events) {
    if (!spec.energy_source) refuse("--events", "photons", "--photons");
    spec.energy_source->events = *options.events;
  }
  if (options.change) options.change(spec);
  return spec;
}

}  // namespace scintray::simulation
