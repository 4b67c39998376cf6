#include "scintray/simulation/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <numeric>

#include "scintray/core/version.hpp"
#include "scintray/simulation/detail/passing_on.hpp"
#include "scintray/simulation/detail/point_sink.hpp"
#include "scintray/simulation/detail/rank_scheduler.hpp"
#include "scintray/simulation/detail/until_watch.hpp"
#include "scintray/simulation/run_names.hpp"

namespace scintray::simulation {

namespace {

std::size_t triangles_of(const scene::BuiltScene& built) {
  std::size_t triangles = 0;
  for (const contact::PlacedMesh& part : built.placed) triangles += part.mesh.triangles.size();
  return triangles;
}

bool stopped(const SimulationHooks& hooks) { return hooks.stop && hooks.stop->load(); }

/// Work of the blocks of a point that belong to a shard: photons or events, to the nearest below.
std::uint64_t work_of(const RunOutline& run, std::size_t point, const Shard& shard) {
  const PointOutline& outline = run.points[point];
  if (shard.of == 1 || outline.blocks == 0) return outline.work;
  const double share = static_cast<double>(blocks_of_point(blocks_of(shard, run), run, point).count()) /
                       static_cast<double>(outline.blocks);
  return static_cast<std::uint64_t>(share * static_cast<double>(outline.work));
}

core::SystemError out_of_memory(const std::string& during, std::size_t point, std::size_t points) {
  return core::SystemError(
      fmt::format("out of memory while {}, point {} of {}\n  hint: fewer threads (--threads), or parts of "
                  "the run one after "
                  "the other (--shard), take less",
                  during, point + 1, points));
}

/// A shard does not have the sums by which a run ends. @throws InputError
void refuse_shard_of_until(const scene_file::SceneSpec& spec, const Shard& shard) {
  if (shard.of == 1 || !spec.run.until) return;
  throw core::InputError(
      {spec.run.until->where,
       "a run that ends by [run] until has no shards: when it ends depends on all of its blocks",
       "remove until, or run without --shard, with mpirun for several machines"});
}

/// Keeps the ranges that were finished before an error, if there is a way to.
void seal_what_there_is(const SimulationHooks& hooks) {
  try {
    if (hooks.checkpoints) hooks.checkpoints->seal();
  } catch (const core::Error&) {  // as on the full disk that was the error
  }
}

}  // namespace

Simulation::Simulation(scene_file::SceneFile file, SimulationOptions options)
    : file_(std::move(file)),
      options_(std::move(options)),
      builder_(options_.surface_hooks, options_.models, mesh_formats_of(options_, &*file_)),
      kept_(file_->points()) {}

Simulation::Simulation(scene_file::SceneSpec scene, SimulationOptions options)
    : scene_(std::move(scene)),
      options_(std::move(options)),
      builder_(options_.surface_hooks, options_.models, mesh_formats_of(options_, nullptr)),
      kept_(1) {}

std::size_t Simulation::points() const { return kept_.size(); }

std::vector<std::string> Simulation::sweep_keys() const {
  return file_ ? file_->sweep_keys() : std::vector<std::string>();
}

std::vector<std::string> Simulation::parameters(std::size_t point) const {
  expect_point(point);
  return file_ ? file_->parameters(point) : std::vector<std::string>();
}

void Simulation::expect_point(std::size_t point) const {
  if (point >= points())
    throw core::InputError(
        core::Problem{{file_ ? file_->spec(0).file.string() : scene_.file.string()},
                      fmt::format("there is no point {}; the scene has {}", point, points()),
                      "points count from 0"});
}

scene_file::SceneSpec Simulation::spec(std::size_t point) const {
  expect_point(point);
  return with_options(file_ ? file_->spec(point) : scene_, options_);
}

std::shared_ptr<const SimulationPoint> Simulation::point(std::size_t point) {
  if (point < points() && kept_[point]) return kept_[point];
  const core::InputRecord files;
  scene_file::SceneSpec spec = this->spec(point);
  std::shared_ptr<const scene::BuiltScene> built = shared_scene(spec);
  const bool shared = built != nullptr;
  if (!shared) {
    built = std::make_shared<const scene::BuiltScene>(builder_.build(spec));
    ++built_;
  }
  auto made =
      std::make_shared<const SimulationPoint>(std::move(spec), built, static_cast<std::uint32_t>(point));
  if (!shared) keep(built);
  kept_[point] = made;
  for (const core::InputFile& file : files.files()) inputs_.insert(file);
  return made;
}

std::shared_ptr<const scene::BuiltScene> Simulation::shared_scene(const scene_file::SceneSpec& spec) {
  const scene::BuiltScene* tried = nullptr;
  for (auto kept = kept_.rbegin(); kept != kept_.rend(); ++kept) {
    if (!*kept || (*kept)->built().get() == tried) continue;
    tried = (*kept)->built().get();
    if (builder_.serves(*tried, (*kept)->spec(), spec)) return (*kept)->built();
  }
  return nullptr;
}

void Simulation::keep(const std::shared_ptr<const scene::BuiltScene>& built) {
  const std::size_t triangles = triangles_of(*built);
  if (triangles_ + triangles <= options_.most_triangles_kept) {
    triangles_ += triangles;
    return;
  }
  for (std::size_t i = 0; beyond_ && i < points(); ++i)
    if (kept_[i] && kept_[i]->built() == beyond_) kept_[i].reset();
  beyond_ = built;
}

void Simulation::release(std::size_t point) {
  if (point >= points() || !kept_[point]) return;
  const std::shared_ptr<const scene::BuiltScene> built = kept_[point]->built();
  kept_[point].reset();
  const auto keeps_it = [&](const auto& kept) { return kept && kept->built() == built; };
  if (std::any_of(kept_.begin(), kept_.end(), keeps_it)) return;
  if (built == beyond_)
    beyond_.reset();
  else
    triangles_ -= triangles_of(*built);
}

void Simulation::build(const SimulationHooks& hooks) {
  if (all_built_) return;
  outline_ = {};
  names_ = {};
  notes_.clear();
  for (std::size_t i = 0; i < points(); ++i) {
    if (stopped(hooks)) throw core::Cancelled("while the scene was built, before any photon was traced");
    try {
      add_to_outline(*point(i));
    } catch (const std::bad_alloc&) {
      throw out_of_memory("the scene was built", i, points());
    }
  }
  tally::RunHeader& header = outline_.header;
  header.version = core::version();
  header.sweep_keys = sweep_keys();
  header.media = names_.media.names();
  header.surfaces = names_.surfaces.names();
  header.parts = names_.parts.names();
  header.faces = names_.faces.names();
  outline_.inputs.assign(inputs_.begin(), inputs_.end());
  all_built_ = true;
}

void Simulation::add_to_outline(const SimulationPoint& point) {
  tally::RunHeader& header = outline_.header;
  if (outline_.points.empty()) {
    const scene_file::SceneSpec& first = point.spec();
    header.title = first.title;
    header.scene_file = first.file.string();
    header.scene_text = first.text;
    header.seed = first.run.seed;
    outline_.photon_list = first.run.photon_list;
    outline_.photons.columns = first.run.photons.columns;
    outline_.photons.every = first.run.photons.every;
    for (const config::NameRef& channel : first.run.photons.channels)
      outline_.photons.channels.push_back(channel.name);
    if (first.run.photon_history) outline_.histories.emplace();
  }
  outline_.paths = outline_.paths || point.spec().run.paths > 0;
  names_.add(point.scene());
  if (outline_.histories && point.plan().history) outline_.histories->add(point.plan().history->subjects());
  outline_.has_energy = point.source().has_energy();
  outline_.points.push_back({parameters(outline_.points.size()), point.work(), point.source().blocks(),
                             point.settings().max_interactions, point.settings().max_time_ns});
  for (const auto* notes : {&point.warnings(), &point.source_notes()})
    for (const std::string& note : *notes)
      if (std::find(notes_.begin(), notes_.end(), note) == notes_.end()) {
        notes_.push_back(note);
        header.note += (header.note.empty() ? "" : "\n") + note;
      }
}

const RunOutline& Simulation::outline() {
  build();
  return outline_;
}

void Simulation::begin(ResultSink& sink, const SimulationHooks& hooks, const Shard& shard) {
  build(hooks);
  sink.begin(outline_);
  const scene_file::SceneSpec first = spec(0);
  if (first.goniometers.empty() || shard.number != 1) return;
  const std::vector<analysis::SurfaceAnalysis> analyses = analysis::analyze_surfaces(
      first.goniometers, builder_.database(first), builder_.surfaces(), first.run.seed);
  sink.surfaces(analyses);
  if (hooks.checkpoints) hooks.checkpoints->surfaces(analyses);
}

SimulationProgress Simulation::start_of(std::size_t number, const Shard& shard) const {
  SimulationProgress progress;
  progress.point = number;
  progress.points = points();
  progress.thing = outline_.has_energy ? "events" : "photons";
  for (std::size_t point = 0; point < points(); ++point) {
    const std::uint64_t work = work_of(outline_, point, shard);
    progress.total += work;
    if (point < number) progress.done += work;
  }
  return progress;
}

tally::PointResult Simulation::trace(std::size_t number, const Tracer& tracer, ResultSink& sink,
                                     const SimulationHooks& hooks, const Shard& shard) {
  build(hooks);
  const std::shared_ptr<const SimulationPoint> traced = point(number);
  const Renumbering renumbering(traced->scene(), names_);
  const tally::HistorySubjects* subjects = detail::subjects_of(*traced);
  PointSink receiver(sink);

  RunHooks run = detail::passing_on(*traced, renumbering, number, receiver);
  run.stop = hooks.stop;
  if (hooks.progress)
    run.progress = [&, start = start_of(number, shard)](std::uint64_t done) {
      SimulationProgress progress = start;
      progress.done += done;
      if (receiver.expected_work) {
        progress.done = until_.work_done + done;
        progress.total = until_.work_done + *receiver.expected_work * until_.points_left;
        progress.error = receiver.error_text;
      }
      hooks.progress(progress);
    };
  detail::begin_events(*traced, renumbering, number, sink);
  if (hooks.checkpoints) detail::begin_events(*traced, renumbering, number, *hooks.checkpoints);
  const bool complete = tracer(*traced, receiver, run);
  if (!receiver.total)
    receiver.total = renumbering.applied(tally::empty_sums(traced->scene(), traced->plan()));
  tally::PointResult result = finished_point(*receiver.total, outline_, number, complete);
  static_cast<tally::PointFacts&>(result) = traced->facts();
  result.until = receiver.until;
  sink.point(result, subjects);
  return result;
}

tally::BlockRange Simulation::blocks_left(std::size_t number, const SimulationHooks& hooks,
                                          const Shard& shard) const {
  tally::BlockRange blocks = blocks_of_point(blocks_of(shard, outline_), outline_, number);
  if (hooks.checkpoints) blocks.first = hooks.checkpoints->next_block(number, blocks.first);
  return blocks;
}

tally::PointResult Simulation::run(std::size_t point, ResultSink& sink, const SimulationHooks& hooks) {
  build(hooks);
  SimulationHooks alone = hooks;
  alone.checkpoints = nullptr;  // they are of a run of all points
  begin_until(1);
  return run_blocks(point, sink, alone, {});
}

tally::PointResult Simulation::run(std::size_t point, const SimulationHooks& hooks) {
  ResultSink nowhere;
  return run(point, nowhere, hooks);
}

tally::PointResult Simulation::run(std::size_t point, const MappedResponse& response, ResultSink& sink,
                                   const SimulationHooks& hooks) {
  const auto tracer = [&](const SimulationPoint& ready, PointSink&, RunHooks& run) {
    return ready.trace(response, run).complete;
  };
  SimulationHooks alone = hooks;
  alone.checkpoints = nullptr;
  return trace(point, tracer, sink, alone, {});
}

tally::RunResult Simulation::run_all(ResultSink& sink, const SimulationHooks& hooks, const Shard& shard) {
  refuse_shard_of_until(spec(0), shard);
  build(hooks);
  if (hooks.checkpoints) hooks.checkpoints->open(outline_, shard);
  const std::unique_ptr<detail::RankScheduler> ranks = scheduler(hooks, shard);
  begin(sink, hooks, shard);
  const tally::BlockRange blocks = blocks_of(shard, outline_);
  tally::RunResult result;
  result.header = header();
  std::size_t ended = 0;
  begin_until(points());
  share_wall_time(hooks);
  try {
    for (; ended < points() && !stopped(hooks); ++ended) {
      if (shard.of > 1 && blocks_of_point(blocks, outline_, ended).count() == 0) continue;
      result.points.push_back(run_blocks(ended, sink, hooks, shard, ranks.get()));
      release(ended);
      if (!result.points.back().complete) break;
    }
  } catch (const std::bad_alloc&) {
    seal_what_there_is(hooks);
    throw out_of_memory("photons were traced and their results written", ended, points());
  } catch (...) {
    seal_what_there_is(hooks);
    throw;
  }
  const bool complete = ended == points();
  if (!complete) result.partial_reason = kStopped;
  if (hooks.checkpoints && !complete) hooks.checkpoints->seal();
  sink.commit(complete, result.partial_reason);
  if (hooks.checkpoints && complete) hooks.checkpoints->remove();
  return result;
}

tally::RunResult Simulation::run_all(const SimulationHooks& hooks) {
  ResultSink nowhere;
  return run_all(nowhere, hooks);
}

source::Photon Simulation::replay(std::size_t number, std::uint64_t event, std::uint64_t photon,
                                  const transport::StepVisitor& visit) {
  return point(number)->replay(event, photon, visit);
}

Simulation::Counts Simulation::counts() const { return {built_, builder_.readings()}; }

}  // namespace scintray::simulation
