#pragma once
/// Simulation of a scene, for the command line, fits, response maps, benchmarks and tests.
///
///     Simulation simulation(SceneFile::load("scene.toml"));
///     ResultsFile file("scene.h5");
///     const RunResult result = simulation.run_all(file);
///     const Estimate light = result.points[0].fraction(Fate::detected);

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "scintray/core/cancelled.hpp"
#include "scintray/scene_file/read_scene.hpp"
#include "scintray/simulation/checkpoints.hpp"
#include "scintray/simulation/result_sink.hpp"
#include "scintray/simulation/run_names.hpp"
#include "scintray/simulation/simulation_options.hpp"
#include "scintray/simulation/simulation_point.hpp"

namespace scintray::simulation {

class PointSink;
class Ranks;

namespace detail {
class RankScheduler;
struct RankJob;
struct RankResult;
class UntilWatch;
}  // namespace detail

/// RunResult::partial_reason of a run that SimulationHooks::stop ended.
inline constexpr const char* kStopped = "stopped by the user";

/// Progress of a run.
struct SimulationProgress {
  std::size_t point = 0, points = 1;  ///< the current point, and the number of points
  std::uint64_t done = 0, total = 0;  ///< over all points
  std::string thing;                  ///< of which: "photons", or "events"
  std::string error;                  ///< "error 1.2 %, goal 0.5 %" of the point, where [run] until has one
};

struct SimulationHooks {
  std::function<void(const SimulationProgress&)> progress;  ///< from one thread at a time
  /// Set from outside: the photons traced are kept, and the result is marked as partial.
  const std::atomic<bool>* stop = nullptr;
  /// Keeps finished blocks of run_all(), and has those of an earlier run; null: none are kept.
  Checkpoints* checkpoints = nullptr;
  /// Processes that compute run_all() together, of which this is rank 0 and the others are in serve(); null:
  /// this one alone.
  Ranks* ranks = nullptr;
};

/// Simulation of a scene with its sweep. Each point is built once (within
/// SimulationOptions::most_triangles_kept), points that differ only in their source, run settings and tallies
/// share one scene, each surface table is made once and each definition of the material database is read
/// once. Results depend on the scene and the options only, to the last bit: not on the number of threads, nor
/// on which points were traced before. To be used by one thread at a time; traces with many.
///
/// Indices of parts, faces, media and surfaces in results are those of header(), which has the names of all
/// points.
///
/// All functions of a point throw InputError for one that does not exist and, when they build it, for the
/// errors of the scene.
class Simulation {
 public:
  explicit Simulation(scene_file::SceneFile file, SimulationOptions options = {});
  /// A scene built in code: one point, without a file.
  explicit Simulation(scene_file::SceneSpec scene, SimulationOptions options = {});

  std::size_t points() const;
  /// Headings of the swept keys, slowest first; empty without a sweep.
  std::vector<std::string> sweep_keys() const;
  /// The value of each swept key at a point, as written ("2 mm").
  std::vector<std::string> parameters(std::size_t point) const;
  /// The scene of a point with the options applied, not yet built.
  scene_file::SceneSpec spec(std::size_t point) const;
  /// A point, built on demand.
  std::shared_ptr<const SimulationPoint> point(std::size_t point);
  /// Releases a point.
  void release(std::size_t point);

  /// Builds every point, so that errors are thrown before the first photon. Called by the functions that need
  /// it.
  /// @throws InputError; Cancelled when it was stopped
  void build(const SimulationHooks& hooks = {});
  /// Information before the first photon, for sinks; builds every point.
  const RunOutline& outline();
  /// Header of the results, with the names that indices refer to; builds every point.
  const tally::RunHeader& header() { return outline().header; }

  /// Begins a sink for the following points, and computes the goniometer readings, which belong to the first
  /// shard.
  void begin(ResultSink& sink, const SimulationHooks& hooks = {}, const Shard& shard = {});
  /// Result of one point. After an early stop it contains the photons traced until then and is not complete.
  /// @param sink  begun before; receives the photons, events and histories that the scene requests, and the
  ///              result
  /// @throws InternalError when a photon has no fate
  tally::PointResult run(std::size_t point, ResultSink& sink, const SimulationHooks& hooks = {});
  tally::PointResult run(std::size_t point, const SimulationHooks& hooks = {});
  /// The same with events from a response map: no photon is traced. @throws InputError as run_mapped
  tally::PointResult run(std::size_t point, const MappedResponse& response, ResultSink& sink,
                         const SimulationHooks& hooks = {});
  /// Begins the sink, traces all points one after the other and commits the sink, also after an early stop.
  /// Points are released when they have been traced. Of a shard, its blocks alone: its points are then not
  /// complete, and the sink is to be a RangeFile.
  tally::RunResult run_all(ResultSink& sink, const SimulationHooks& hooks = {}, const Shard& shard = {});
  tally::RunResult run_all(const SimulationHooks& hooks = {});
  /// Traces the blocks that rank 0, in run_all(), assigns to this process, until it ends the run. To be
  /// called within run_part(), as run_all() with ranks is.
  void serve(Ranks& ranks, const SimulationHooks& hooks = {});

  /// Replays one photon of run(); `visit` is called for every step. Returns the photon as it ended.
  /// @throws InputError when there is no such photon
  source::Photon replay(std::size_t point, std::uint64_t event, std::uint64_t photon,
                        const transport::StepVisitor& visit);

  /// Statistics of the work done so far.
  struct Counts {
    std::size_t scenes_built = 0;
    materials::MaterialDatabase::Readings definitions;
  };
  Counts counts() const;

 private:
  /// Traces a point, or makes its events otherwise, and passes all to a sink. Returns true when nothing is
  /// left.
  using Tracer = std::function<bool(const SimulationPoint&, PointSink&, RunHooks&)>;

  void expect_point(std::size_t point) const;
  /// The scene of a kept point, where it is the same as that of `spec`; else nothing.
  std::shared_ptr<const scene::BuiltScene> shared_scene(const scene_file::SceneSpec& spec);
  void keep(const std::shared_ptr<const scene::BuiltScene>& built);
  void add_to_outline(const SimulationPoint& point);
  tally::PointResult trace(std::size_t number, const Tracer& tracer, ResultSink& sink,
                           const SimulationHooks& hooks, const Shard& shard);
  /// Result of the blocks of a point that belong to a shard; those among the checkpoints are taken from
  /// there.
  /// @param ranks  that trace the others; null: this process alone does
  tally::PointResult run_blocks(std::size_t number, ResultSink& sink, const SimulationHooks& hooks,
                                const Shard& shard, detail::RankScheduler* ranks = nullptr);
  /// Passes the paths that the scene requests of a point on, where its first block belongs to the shard.
  /// Earlier checkpoints have them with that block.
  void record_paths(std::size_t number, ResultSink& sink, const SimulationHooks& hooks, const Shard& shard);
  /// Blocks of a point that belong to a shard and are not among the checkpoints.
  tally::BlockRange blocks_left(std::size_t number, const SimulationHooks& hooks, const Shard& shard) const;
  /// What hands the blocks of a run out to ranks; null for one process.
  std::unique_ptr<detail::RankScheduler> scheduler(const SimulationHooks& hooks, const Shard& shard);
  /// What traces jobs of a point; it may be called on another thread.
  std::function<detail::RankResult(const detail::RankJob&, const std::atomic<bool>&)> job_tracer(
      std::size_t number);
  SimulationProgress start_of(std::size_t number, const Shard& shard) const;
  /// What decides when a point ends, by its [run] until; null without it.
  std::unique_ptr<detail::UntilWatch> watch_of(const SimulationPoint& point, std::size_t number) const;
  /// Begins the wall time and the progress of so many points that end by [run] until.
  void begin_until(std::size_t points);
  /// Shares the wall time of [run] until out to the points of a sweep, by a short trial of each.
  void share_wall_time(const SimulationHooks& hooks);

  std::optional<scene_file::SceneFile> file_;
  scene_file::SceneSpec scene_;  ///< when there is no file
  SimulationOptions options_;
  scene::SceneBuilder builder_;
  std::vector<std::shared_ptr<const SimulationPoint>> kept_;
  std::shared_ptr<const scene::BuiltScene> beyond_;  ///< the one kept scene that is beyond the limit
  std::size_t triangles_ = 0;                        ///< of the other scenes that are kept, each once
  std::size_t built_ = 0;

  bool all_built_ = false;
  RunOutline outline_;
  RunNames names_;
  std::vector<std::string> notes_;    ///< in the header, each once
  std::set<core::InputFile> inputs_;  ///< read for all points so far

  /// Of the points that run() or run_all() traces.
  struct UntilState {
    std::chrono::steady_clock::time_point start{};
    std::size_t points_left = 1;  ///< the present one included
    std::uint64_t work_done = 0;  ///< of the points before
    std::vector<double> shares;   ///< of the wall time, by point; empty: all alike
  } until_;
};

}  // namespace scintray::simulation
