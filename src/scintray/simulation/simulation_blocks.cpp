// The blocks of one point: traced here or by ranks, kept in checkpoints, and ended by [run] until.
#include <limits>

#include "scintray/simulation/detail/point_sink.hpp"
#include "scintray/simulation/detail/rank_scheduler.hpp"
#include "scintray/simulation/detail/until_watch.hpp"
#include "scintray/simulation/photon_paths.hpp"
#include "scintray/simulation/simulation.hpp"

namespace scintray::simulation {

void Simulation::begin_until(std::size_t points) { until_ = {std::chrono::steady_clock::now(), points, 0}; }

std::unique_ptr<detail::UntilWatch> Simulation::watch_of(const SimulationPoint& point,
                                                         std::size_t number) const {
  const std::optional<scene_file::UntilSpec>& until = point.spec().run.until;
  if (!until) return nullptr;
  double seconds = std::numeric_limits<double>::infinity();
  if (until->wall_time_s) {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - until_.start;
    seconds = (*until->wall_time_s - elapsed.count()) / static_cast<double>(until_.points_left);
  }
  return std::make_unique<detail::UntilWatch>(*until, outline_, number, seconds,
                                              point.facts().birth_efficiency);
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
      return watch->has_ended();
    };
    const auto finish = [&](bool complete) {
      if (watch && receiver.total) receiver.until = watch->result(*receiver.total);
      if (receiver.total) until_.work_done += work_in(*receiver.total);
      if (until_.points_left > 1) --until_.points_left;
      return complete;
    };
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
