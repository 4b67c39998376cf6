#include "scintray/io/simulate.hpp"

#include <algorithm>
#include <map>

#include "scintray/analysis/surface_study.hpp"
#include "scintray/core/version.hpp"
#include "scintray/io/results.hpp"
#include "scintray/trace/light_timing.hpp"
#include "scintray/trace/run.hpp"

namespace scintray {

namespace {

/// Names of a kind over all points of a sweep: points may differ in their media and surfaces, results
/// have one list.
class NameList {
 public:
  std::uint32_t index(const std::string& name) {
    const auto [known, is_new] = index_.try_emplace(name, static_cast<std::uint32_t>(names_.size()));
    if (is_new) names_.push_back(name);
    return known->second;
  }
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::vector<std::string> names_;
  std::map<std::string, std::uint32_t> index_;
};

struct NameLists {
  NameList media, surfaces, parts, faces;

  void add(const Scene& scene) {
    for (const SceneMedium& medium : scene.media) media.index(medium.medium().name);
    for (const Surface& surface : scene.surfaces) surfaces.index(surface.name);
    for (const PartInfo& part : scene.parts) parts.index(part.name);
    for (const FaceInfo& face : scene.faces) faces.index(face.name);
  }
};

/// Rewrites a point's indices from its scene's lists to the run's.
class Renumbering {
 public:
  Renumbering(const Scene& scene, NameLists& lists) : lists_(lists) {
    for (const SceneMedium& medium : scene.media) media_.push_back(lists.media.index(medium.medium().name));
    for (const Surface& surface : scene.surfaces) surfaces_.push_back(lists.surfaces.index(surface.name));
    for (const PartInfo& part : scene.parts) parts_.push_back(lists.parts.index(part.name));
    for (const FaceInfo& face : scene.faces) faces_.push_back(lists.faces.index(face.name));
  }

  void apply(PointResult& result) const {
    result.absorbed_in_medium = moved(result.absorbed_in_medium, media_, lists_.media.names().size());
    result.absorbed_at_surface = moved(result.absorbed_at_surface, surfaces_, lists_.surfaces.names().size());
    result.shifted_in_medium = moved(result.shifted_in_medium, media_, lists_.media.names().size());
    result.shifted_at_surface = moved(result.shifted_at_surface, surfaces_, lists_.surfaces.names().size());
    for (SensorFaceCount& count : result.sensor_faces) {
      count.part = parts_[count.part];
      count.face = faces_[count.face];
    }
    for (ExitAngleTally& tally : result.exit_angles) tally.face = faces_[tally.face];
  }

  std::vector<ReadoutChannel> applied(std::vector<ReadoutChannel> channels) const {
    for (ReadoutChannel& channel : channels) {
      channel.part = parts_[channel.part];
      if (channel.face != kNone)
        channel.face = static_cast<std::int32_t>(faces_[static_cast<std::size_t>(channel.face)]);
    }
    return channels;
  }

  std::vector<EventRecord> applied(std::vector<EventRecord> events) const {
    for (EventRecord& event : events)
      if (event.part != EventRecord::kNoPart) event.part = parts_[event.part];
    return events;
  }

  std::vector<DetectedPhoton> applied(std::vector<DetectedPhoton> photons) const {
    for (DetectedPhoton& photon : photons) {
      photon.part = parts_[photon.part];
      photon.face = faces_[photon.face];
    }
    return photons;
  }

 private:
  template <typename Count>
  static std::vector<Count> moved(const std::vector<Count>& counts, const std::vector<std::uint32_t>& to,
                                  std::size_t size) {
    std::vector<Count> result(size);
    for (std::size_t i = 0; i < counts.size(); ++i) result[to[i]] += counts[i];
    return result;
  }

  NameLists& lists_;
  std::vector<std::uint32_t> media_, surfaces_, parts_, faces_;
};

/// Everything known before the first photon.
struct Survey {
  NameLists names;
  HistoryColumns histories;
  std::vector<std::string> notes;
  bool energy = false;     ///< some source is one of energy
  std::uint64_t work = 0;  ///< photons, or events, over all points
};

/// Builds every point once: finds mistakes, names, and surface tables.
Survey survey_points(const SceneFile& file, const SimulationOptions& options, SceneBuilder& builder) {
  Survey survey;
  for (std::size_t point = 0; point < file.points(); ++point) {
    const SceneSpec spec = with_options(file.spec(point), options);
    const BuiltScene built = builder.build(spec);
    std::vector<std::string> notes = built.warnings;
    const std::unique_ptr<LightSource> source = make_light_source(spec, built.scene, &notes);
    const TallyPlan plan(built.scene, spec);
    survey.names.add(built.scene);
    if (plan.history) survey.histories.add(plan.history->subjects());
    survey.energy = source->has_energy();
    survey.work += source->has_energy() ? source->events() : source->photons();
    for (const std::string& note : notes)
      if (std::find(survey.notes.begin(), survey.notes.end(), note) == survey.notes.end())
        survey.notes.push_back(note);
  }
  return survey;
}

RunHeader make_header(const SceneFile& file, const SceneSpec& first, const Survey& survey) {
  RunHeader header;
  header.title = first.title;
  header.version = version();
  header.scene_file = first.file.string();
  header.scene_text = file.text();
  header.seed = first.run.seed;
  header.sweep_keys = file.sweep_keys();
  header.media = survey.names.media.names();
  header.surfaces = survey.names.surfaces.names();
  header.parts = survey.names.parts.names();
  header.faces = survey.names.faces.names();
  for (const std::string& note : survey.notes) header.note += (header.note.empty() ? "" : "\n") + note;
  return header;
}

}  // namespace

RunSettings run_settings(const RunSpec& run, std::uint32_t point) {
  RunSettings settings;
  settings.seed = run.seed;
  settings.point = point;
  settings.max_interactions = run.max_interactions;
  settings.max_time_ns = run.max_time_ns;
  settings.threads = run.threads.value_or(0);
  return settings;
}

SceneSpec with_options(SceneSpec spec, const SimulationOptions& options) {
  if (options.threads) spec.run.threads = options.threads;
  if (options.seed) spec.run.seed = *options.seed;
  const auto refuse = [&](const char* option, const char* source, const char* other) {
    throw InputError({spec.energy_source ? spec.energy_source->where : spec.source.where,
                      std::string(option) + " is given, but this is a source of " + source,
                      std::string("use ") + other});
  };
  if (options.quick) {
    const auto& number = spec.energy_source ? spec.energy_source->quick_events : spec.source.quick_photons;
    const std::string key = spec.energy_source ? "quick_events" : "quick_photons";
    if (!number)
      throw InputError({spec.energy_source ? spec.energy_source->where : spec.source.where,
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
  return spec;
}

RunResult simulate(const SceneFile& file, const SimulationOptions& options) {
  SceneBuilder builder(options.surface_hooks);
  Survey survey = survey_points(file, options, builder);
  const SceneSpec first = with_options(file.spec(0), options);
  RunResult result;
  result.header = make_header(file, first, survey);
  ResultsWriter writer(options.output, result.header, first.run.photon_list);
  if (first.run.photon_history) writer.begin_histories(survey.histories);
  if (!first.benches.empty())
    writer.add_surfaces(
        study_surfaces(first.benches, library_for(first), builder.surfaces(), first.run.seed));

  SimulationProgress progress;
  progress.points = file.points();
  progress.thing = survey.energy ? "events" : "photons";
  progress.total = survey.work;
  std::uint64_t done_before = 0;
  for (std::size_t point = 0; point < file.points() && !(options.stop && options.stop->load()); ++point) {
    const SceneSpec spec = with_options(file.spec(point), options);
    const BuiltScene built = builder.build(spec);
    const std::unique_ptr<LightSource> source = make_light_source(spec, built.scene);
    const TallyPlan plan(built.scene, spec);
    const Renumbering renumbering(built.scene, survey.names);

    RunHooks hooks;
    hooks.stop = options.stop;
    hooks.progress = [&](std::uint64_t done) {
      progress.point = point;
      progress.done = done_before + done;
      if (options.progress) options.progress(progress);
    };
    if (spec.run.photon_list)
      hooks.detected = [&](const std::vector<DetectedPhoton>& photons) {
        writer.append_photons(renumbering.applied(photons));
      };
    if (plan.history && first.run.photon_history)
      hooks.histories = [&](const PhotonHistories& histories) {
        writer.append_histories(histories, plan.history->subjects());
      };
    if (source->has_energy()) {
      writer.begin_events(point, renumbering.applied(plan.channels.list), spec.readout);
      hooks.events = [&](const std::vector<EventRecord>& events) {
        writer.append_events(renumbering.applied(events));
      };
    }
    PointResult traced = run_point(built.scene, *source, plan,
                                   run_settings(spec.run, static_cast<std::uint32_t>(point)), hooks);
    traced.parameters = file.parameters(point);
    traced.light_timing = light_timing(built.scene, spec, *source, plan);
    renumbering.apply(traced);
    done_before = progress.done;
    progress.segments += traced.segments;
    writer.add_point(traced, plan.history ? &plan.history->subjects() : nullptr);
    result.points.push_back(std::move(traced));
  }
  const bool complete = result.points.size() == file.points() && result.complete();
  writer.commit(complete, complete ? "" : "stopped by the user");
  return result;
}

}  // namespace scintray
