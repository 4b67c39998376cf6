#include "scintray/simulation/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "scintray/core/version.hpp"

namespace scintray::simulation {

namespace {

std::size_t triangles_of(const scene::BuiltScene& built) {
  std::size_t triangles = 0;
  for (const contact::PlacedMesh& part : built.placed) triangles += part.mesh.triangles.size();
  return triangles;
}

bool stopped(const SimulationHooks& hooks) { return hooks.stop && hooks.stop->load(); }

}  // namespace

Simulation::Simulation(scene_file::SceneFile file, SimulationOptions options)
    : file_(std::move(file)),
      options_(std::move(options)),
      builder_(options_.surface_hooks, *options_.mesh_formats),
      kept_(file_->points()) {}

Simulation::Simulation(scene_file::SceneSpec scene, SimulationOptions options)
    : scene_(std::move(scene)),
      options_(std::move(options)),
      builder_(options_.surface_hooks, *options_.mesh_formats),
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
  if (point < points() && kept_[point].point) return kept_[point].point;
  auto built =
      std::make_shared<const SimulationPoint>(spec(point), builder_, static_cast<std::uint32_t>(point));
  ++built_;
  keep(point, built);
  return built;
}

void Simulation::keep(std::size_t number, std::shared_ptr<const SimulationPoint> point) {
  const std::size_t triangles = triangles_of(*point->built());
  const bool fits = triangles_ + triangles <= options_.most_triangles_kept;
  if (!fits && beyond_) release(*beyond_);
  kept_[number] = {std::move(point), triangles};
  if (fits)
    triangles_ += triangles;
  else
    beyond_ = number;
}

void Simulation::release(std::size_t point) {
  if (point >= points() || !kept_[point].point) return;
  if (beyond_ == point)
    beyond_.reset();
  else
    triangles_ -= kept_[point].triangles;
  kept_[point] = {};
}

void Simulation::build(const SimulationHooks& hooks) {
  if (all_built_) return;
  outline_ = {};
  names_ = {};
  notes_.clear();
  work_.clear();
  for (std::size_t i = 0; i < points(); ++i) {
    if (stopped(hooks)) throw core::Cancelled("the scene was being built, and nothing was traced");
    add_to_outline(*point(i));
  }
  tally::RunHeader& header = outline_.header;
  header.version = core::version();
  header.sweep_keys = sweep_keys();
  header.media = names_.media.names();
  header.surfaces = names_.surfaces.names();
  header.parts = names_.parts.names();
  header.faces = names_.faces.names();
  all_built_ = true;
}

void Simulation::add_to_outline(const SimulationPoint& point) {
  tally::RunHeader& header = outline_.header;
  if (work_.empty()) {
    const scene_file::SceneSpec& first = point.spec();
    header.title = first.title;
    header.scene_file = first.file.string();
    header.scene_text = first.text;
    header.seed = first.run.seed;
    outline_.photon_list = first.run.photon_list;
    if (first.run.photon_history) outline_.histories.emplace();
  }
  names_.add(point.scene());
  if (outline_.histories && point.plan().history) outline_.histories->add(point.plan().history->subjects());
  energy_ = point.source().has_energy();
  work_.push_back(point.work());
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

void Simulation::begin(ResultSink& sink, const SimulationHooks& hooks) {
  build(hooks);
  sink.begin(outline_);
  const scene_file::SceneSpec first = spec(0);
  if (!first.goniometers.empty())
    sink.surfaces(analysis::analyze_surfaces(first.goniometers, builder_.database(first), builder_.surfaces(),
                                             first.run.seed));
}

SimulationProgress Simulation::start_of(std::size_t number) const {
  SimulationProgress progress;
  progress.point = number;
  progress.points = points();
  progress.thing = energy_ ? "events" : "photons";
  const auto before = work_.begin() + static_cast<std::ptrdiff_t>(number);
  progress.done = std::accumulate(work_.begin(), before, std::uint64_t{0});
  progress.total = std::accumulate(before, work_.end(), progress.done);
  return progress;
}

tally::PointResult Simulation::trace(std::size_t number, const Tracer& tracer, ResultSink& sink,
                                     const SimulationHooks& hooks) {
  build(hooks);
  const std::shared_ptr<const SimulationPoint> traced = point(number);
  const Renumbering renumbering(traced->scene(), names_);
  const tally::HistorySubjects* subjects =
      traced->plan().history ? &traced->plan().history->subjects() : nullptr;

  RunHooks run;
  run.stop = hooks.stop;
  if (hooks.progress)
    run.progress = [&, start = start_of(number)](std::uint64_t done) {
      SimulationProgress progress = start;
      progress.done += done;
      hooks.progress(progress);
    };
  if (traced->spec().run.photon_list)
    run.detected = [&](const std::vector<tally::DetectedPhoton>& photons) {
      sink.photons(renumbering.applied(photons));
    };
  if (subjects)
    run.histories = [&](const tally::PhotonHistories& histories) { sink.histories(histories, *subjects); };
  if (traced->source().has_energy()) {
    sink.begin_events(number, renumbering.applied(traced->plan().channels.list), traced->spec().readout);
    run.events = [&](const std::vector<tally::EventRecord>& events) {
      sink.events(renumbering.applied(events));
    };
  }
  tally::PointResult result = tracer(*traced, run);
  result.parameters = parameters(number);
  renumbering.apply(result);
  sink.point(result, subjects);
  return result;
}

tally::PointResult Simulation::run(std::size_t point, ResultSink& sink, const SimulationHooks& hooks) {
  return trace(
      point, [](const SimulationPoint& ready, const RunHooks& run) { return ready.trace(run); }, sink, hooks);
}

tally::PointResult Simulation::run(std::size_t point, const SimulationHooks& hooks) {
  ResultSink nowhere;
  return run(point, nowhere, hooks);
}

tally::PointResult Simulation::run(std::size_t point, const MappedResponse& response, ResultSink& sink,
                                   const SimulationHooks& hooks) {
  return trace(
      point, [&](const SimulationPoint& ready, const RunHooks& run) { return ready.trace(response, run); },
      sink, hooks);
}

tally::RunResult Simulation::run_all(ResultSink& sink, const SimulationHooks& hooks) {
  begin(sink, hooks);
  tally::RunResult result;
  result.header = header();
  for (std::size_t i = 0; i < points() && !stopped(hooks); ++i) {
    result.points.push_back(run(i, sink, hooks));
    release(i);
  }
  const bool complete = result.points.size() == points() && result.complete();
  if (!complete) result.partial_reason = kStopped;
  sink.commit(complete, result.partial_reason);
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
