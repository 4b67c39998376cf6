// The blocks of one point: traced here or by ranks, kept in checkpoints, and ended by [run] until.
#include <limits>
#include <numeric>

#include "scintray/simulation/detail/goal_watch.hpp"
#include "scintray/simulation/detail/point_sink.hpp"
#include "scintray/simulation/detail/rank_scheduler.hpp"
#include "scintray/simulation/detail/until_watch.hpp"
#include "scintray/simulation/photon_paths.hpp"
#include "scintray/simulation/simulation.hpp"

namespace scintray::simulation {

namespace {

/// Of the wall time, what the trials of all points may take.
constexpr double kTrialShare = 0.2;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Sums over the first blocks of a point, up to the first decision, and the relative error of what its
/// until names: of a result of events that is not known yet, that of the detected photons per event.
double trial_error(const SimulationPoint& point, const std::atomic<bool>* stop) {
  detail::GoalWatch goal(point);
  tally::PointSums sums = tally::empty_sums(point.scene(), point.plan());
  RunHooks hooks;
  hooks.stop = stop;
  hooks.events = [&](const std::vector<tally::EventRecord>& events) { goal.add(events); };
  if (!point.source().has_energy()) hooks.events = nullptr;
  hooks.range = [&](const tally::BlockRange&, const tally::PointSums& more) { sums.merge(more); };
  const std::uint64_t blocks =
      std::min(point.source().blocks(), detail::next_decision(0, point.source().has_energy()));
  point.trace({0, blocks}, hooks);
  std::optional<core::Estimate> estimate = goal.estimate(sums);
  if (!estimate && point.source().has_energy()) estimate = sums.energy.detected.value().mean();
  return estimate && estimate->value > 0.0 ? estimate->error / estimate->value : 0.0;
}

}  // namespace

void Simulation::begin_until(std::size_t points) {
  until_ = {std::chrono::steady_clock::now(), points, 0, {}};
}

void Simulation::share_wall_time(const SimulationHooks& hooks) {
  const std::optional<scene_file::UntilSpec> until = spec(0).run.until;
  if (!until || !until->wall_time_s || points() < 2) return;
  std::vector<double> seconds, errors;
  for (std::size_t number = 0; number < points(); ++number) {
    const std::shared_ptr<const SimulationPoint> tried = point(number);
    if (!tried->spec().run.until) return;
    const auto start = std::chrono::steady_clock::now();
    errors.push_back(trial_error(*tried, hooks.stop));
    seconds.push_back(seconds_since(start));
    if (seconds_since(until_.start) > kTrialShare * *until->wall_time_s) return;  // too few for an estimate
  }
  until_.shares = detail::time_shares(seconds, errors);
}

std::unique_ptr<detail::UntilWatch> Simulation::watch_of(const SimulationPoint& point,
                                                         std::size_t number) const {
  const std::optional<scene_file::UntilSpec>& until = point.spec().run.until;
  if (!until) return nullptr;
  double seconds = std::numeric_limits<double>::infinity();
  if (until->wall_time_s) {
    const double left = *until->wall_time_s - seconds_since(until_.start);
    double share = 1.0 / static_cast<double>(until_.points_left);
    if (!until_.shares.empty()) {
      const auto own = until_.shares.begin() + static_cast<std::ptrdiff_t>(number);
      share = *own / std::accumulate(own, until_.shares.end(), 0.0);
    }
    seconds = left * share;
  }
  return std::make_unique<detail::UntilWatch>(point, seconds);
}

tally::PointResult Simulation::run_blocks(std::size_t number, ResultSink& sink, const SimulationHooks& hooks,
                                          const Shard& shard, detail::RankScheduler* ranks) {
  const auto work_in = [this](const tally::PointSums& sums) {
    return outline_.has_energy ? sums.energy.events : sums.counts.emitted;
  };
  const auto tracer = [&](const SimulationPoint& ready, PointSink& receiver, RunHooks& run) {
    const tally::BlockRange blocks = blocks_left(number, hooks, shard);
    const std::unique_ptr<detail::UntilWatch> watch = watch_of(ready, number);
    const auto seal_when_due = [&] {
      if (hooks.checkpoints && hooks.checkpoints->due()) hooks.checkpoints->seal();
    };
    /// True when the point needs no more blocks.
    const auto has_ended = [&] {
      if (!watch || !receiver.total) return false;
      watch->look(receiver.blocks, *receiver.total);
      receiver.expected_work = watch->expected_work();
      receiver.error_text = watch->error_text();
      return watch->has_ended();
    };
    const auto finish = [&](bool complete) {
      receiver.watch_events = nullptr;
      if (watch && receiver.total) receiver.until = watch->result(*receiver.total);
      if (receiver.total) until_.work_done += work_in(*receiver.total);
      if (until_.points_left > 1) --until_.points_left;
      return complete;
    };
    if (watch)
      receiver.watch_events = [&](const std::vector<tally::EventRecord>& events) { watch->add(events); };
    if (hooks.checkpoints) {
      hooks.checkpoints->replay(number, receiver);
      receiver.also = hooks.checkpoints;
    }
    std::uint64_t done = receiver.total ? work_in(*receiver.total) : 0;
    if (has_ended()) {
      if (ranks) ranks->drop(number);
      return finish(true);
    }
    if (ranks)
      return finish(ranks->collect(number, receiver, hooks.stop, [&](const RangeReader::Content& range) {
        seal_when_due();
        done += work_in(range.sums);
        const bool ended = has_ended();
        if (run.progress) run.progress(done);
        return ended;
      }));
    if (hooks.checkpoints || watch) {
      run.range_ends = [&](const tally::BlockRange& present) {
        return (hooks.checkpoints && hooks.checkpoints->due()) || (watch && watch->is_due(present.last));
      };
      run.range = [&, pass_on = run.range](const tally::BlockRange& range, tally::PointSums sums) {
        pass_on(range, std::move(sums));
        seal_when_due();
        has_ended();
      };
    }
    if (watch) run.enough = [&] { return watch->has_ended(); };
    if (run.progress && done > 0)
      run.progress = [show = run.progress, done](std::uint64_t more) { show(done + more); };
    const bool all = ready.trace(blocks, run).last == blocks.last;
    return finish(all || (watch && watch->has_ended()));
  };
  record_paths(number, sink, hooks, shard);
  return trace(number, tracer, sink, hooks, shard);
}

void Simulation::record_paths(std::size_t number, ResultSink& sink, const SimulationHooks& hooks,
                              const Shard& shard) {
  const tally::BlockRange blocks = blocks_of_point(blocks_of(shard, outline_), outline_, number);
  if (!outline_.paths || blocks.first != 0 || blocks.count() == 0) return;
  const std::shared_ptr<const SimulationPoint> traced = point(number);
  const std::vector<tally::PhotonPath> paths = photon_paths(*traced, traced->spec().run.paths, hooks.stop);
  sink.paths(number, paths);
  if (hooks.checkpoints && hooks.checkpoints->next_block(number, 0) == 0)
    hooks.checkpoints->paths(number, paths);
}

}  // namespace scintray::simulation
