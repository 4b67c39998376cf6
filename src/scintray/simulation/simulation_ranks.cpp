// A run by several processes: the assignment by rank 0, and the work of the others.
#include <tbb/task_arena.h>

#include <memory>
#include <thread>

#include "scintray/simulation/detail/passing_on.hpp"
#include "scintray/simulation/detail/range_stream.hpp"
#include "scintray/simulation/detail/rank_scheduler.hpp"
#include "scintray/simulation/detail/rank_work.hpp"
#include "scintray/simulation/detail/until_watch.hpp"
#include "scintray/simulation/simulation.hpp"

namespace scintray::simulation {

namespace {

constexpr std::chrono::milliseconds kPatience{1};
/// Signs of life within the time after which a rank without one counts as hung.
constexpr int kSignsOfLife = 12;
/// Time for the other ranks to end.
constexpr std::chrono::milliseconds kEndPatience{5000};

bool stop_requested(const SimulationHooks& hooks) { return hooks.stop && hooks.stop->load(); }

/// Threads that trace jobs with these settings.
std::uint32_t threads_of(const SimulationPoint& point) {
  const int threads = point.settings().threads;
  return static_cast<std::uint32_t>(
      tbb::task_arena(threads > 0 ? threads : tbb::task_arena::automatic).max_concurrency());
}

/// Messages of a kind that others may precede: waits for `count` of them, up to a time. Returns how many
/// came.
int await(Ranks& ranks, detail::MessageKind kind, int count, std::optional<std::chrono::milliseconds> most) {
  const auto start = std::chrono::steady_clock::now();
  int came = 0;
  while (came < count && (!most || std::chrono::steady_clock::now() - start < *most)) {
    const std::optional<Ranks::Message> next = ranks.receive();
    if (!next)
      std::this_thread::sleep_for(kPatience);
    else if (detail::kind_of(next->bytes) == kind)
      ++came;
  }
  return came;
}

/// Ends all other ranks, of rank 0. Those that do not answer are left to the destructor of Ranks.
void end_others(Ranks& ranks) {
  for (int rank = 1; rank < ranks.size(); ++rank) ranks.send(rank, message(detail::MessageKind::end));
  const int others = ranks.size() - 1;
  if (await(ranks, detail::MessageKind::ended, others, kEndPatience) == others) ranks.close();
}

}  // namespace

detail::TraceJob Simulation::job_tracer(std::size_t number) {
  const std::shared_ptr<const SimulationPoint> traced = point(number);
  auto renumbering = std::make_shared<const Renumbering>(traced->scene(), names_);
  return [traced, renumbering, number, photons = outline_.photons](const detail::RankJob& job,
                                                                   const std::atomic<bool>& stop) {
    const auto start = std::chrono::steady_clock::now();
    detail::RankResult result;
    result.number = job.number;
    detail::RangeWriter writer([&](std::string_view bytes) { result.records.append(bytes); }, photons);
    RunHooks run = detail::passing_on(*traced, *renumbering, number, writer);
    detail::begin_events(*traced, *renumbering, number, writer);
    run.stop = &stop;
    result.last = traced->trace(job.blocks, run).last;
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
  };
}

std::unique_ptr<detail::RankScheduler> Simulation::scheduler(const SimulationHooks& hooks,
                                                             const Shard& shard) {
  if (!hooks.ranks || hooks.ranks->size() == 1) return nullptr;
  std::vector<detail::RankScheduler::Work> work;
  for (std::size_t number = 0; number < points(); ++number)
    if (const tally::BlockRange blocks = blocks_left(number, hooks, shard); blocks.count() > 0)
      work.push_back({number, blocks});
  const auto tracer_of =
      [this, kept = std::pair<std::size_t, detail::TraceJob>{points(), nullptr}](std::size_t number) mutable {
        if (kept.first != number) kept = {number, job_tracer(number)};
        return kept.second;
      };
  auto made = std::make_unique<detail::RankScheduler>(*hooks.ranks, outline_, std::move(work), tracer_of,
                                                      threads_of(*point(0)));
  made->set_patience(hooks.ranks->patience());
  if (spec(0).run.until)
    made->divide_at(
        [energy = outline_.has_energy](std::uint64_t first) { return detail::next_decision(first, energy); });
  return made;
}

void Simulation::serve(Ranks& ranks, const SimulationHooks& hooks) {
  build(hooks);
  ranks.send(0, message(detail::RankReady{threads_of(*point(0)), outline_}));
  detail::RankWorker worker;
  std::pair<std::size_t, detail::TraceJob> tracer{0, job_tracer(0)};
  auto sent = std::chrono::steady_clock::now();
  for (bool stopping = false;;) {
    while (const std::optional<Ranks::Message> next = ranks.receive()) {
      const detail::MessageKind kind = detail::kind_of(next->bytes);
      if (kind == detail::MessageKind::end) return;
      if (kind == detail::MessageKind::stop) {
        worker.stop();
        continue;
      }
      detail::RankJob job;
      read_message(next->bytes, job);
      if (tracer.first != job.point) tracer = {job.point, job_tracer(job.point)};
      for (std::size_t before = 0; before < job.point; ++before) release(before);
      worker.add(job, tracer.second);
    }
    if (!stopping && stop_requested(hooks)) {
      stopping = true;
      worker.stop();
      ranks.send(0, message(detail::MessageKind::stop));
    }
    const std::optional<detail::RankResult> result = worker.take(kPatience);
    const auto now = std::chrono::steady_clock::now();
    if (!result && now - sent < ranks.patience() / kSignsOfLife) continue;
    ranks.send(0, result ? message(*result) : message(detail::MessageKind::alive));
    sent = now;
  }
}

void run_part(Ranks& ranks, const std::function<void()>& part) {
  if (ranks.rank() == 0) {
    try {
      part();
    } catch (...) {
      end_others(ranks);
      throw;
    }
    return end_others(ranks);
  }
  try {
    part();
  } catch (...) {
    ranks.send(0, message(detail::RankFailure::current()));
    await(ranks, detail::MessageKind::end, 1, std::nullopt);
  }
  ranks.send(0, message(detail::MessageKind::ended));
  ranks.close();
}

}  // namespace scintray::simulation
