#include "scintray/simulation/detail/rank_scheduler.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "scintray/core/error.hpp"
#include "scintray/simulation/detail/range_stream.hpp"

namespace scintray::simulation::detail {

namespace {

/// Jobs that a rank has at once: one that it traces, and one that waits so that it need not.
constexpr int kJobsPerRank = 2;
/// Time of a job: long beside a message, short beside a run.
constexpr double kJobSeconds = 0.5;
/// Blocks of a job for each thread: at its end threads wait for half a block each.
constexpr std::uint64_t kBlocksPerThread = 16;
/// Share of the remaining blocks that all ranks may have at once, as 1 of this number.
constexpr std::uint64_t kShare = 4;
/// Of the time of rank 0 the share that passing results on may take: jobs are longer where it were more.
constexpr double kPassingShare = 0.2;
constexpr double kMostJobBytes = 32.0 * 1024 * 1024;
/// Results that wait for one before them, so that a slow rank does not fill the memory of rank 0.
constexpr std::size_t kMostWaitingBytes = std::size_t{1} << 30, kMostWaitingPerRank = 8;
constexpr std::chrono::milliseconds kPatience{1};
/// Time for the blocks under way after a signal: mpirun ends the processes a second after it.
constexpr std::chrono::milliseconds kStopPatience{700};

}  // namespace

RankScheduler::RankScheduler(Ranks& ranks, const RunOutline& run, std::vector<Work> work, TracerOf tracer_of,
                             std::uint32_t threads)
    : ranks_(ranks),
      run_(run),
      work_(work.begin(), work.end()),
      tracer_of_(std::move(tracer_of)),
      states_(static_cast<std::size_t>(ranks.size())) {
  for (const Work& one : work) blocks_left_ += one.blocks.count();
  states_.front().threads = threads;
  states_.front().ready = true;
}

void RankScheduler::stop_ranks() {
  worker_.stop();
  for (int rank = 1; rank < ranks_.size(); ++rank) ranks_.send(rank, message(MessageKind::stop));
}

bool RankScheduler::has_work(std::size_t point) const {
  const auto is_of_point = [&](const Job& job) { return job.job.point == point && !job.dropped; };
  return std::any_of(jobs_.begin(), jobs_.end(), is_of_point) ||
         (!work_.empty() && work_.front().point == point);
}

void RankScheduler::drop(std::size_t point) {
  if (!work_.empty() && work_.front().point == point) {
    blocks_left_ -= work_.front().blocks.count();
    work_.pop_front();
  }
  for (Job& job : jobs_) job.dropped = job.dropped || job.job.point == point;
}

void RankScheduler::forget_dropped() {
  while (!jobs_.empty() && jobs_.front().dropped && jobs_.front().result) {
    bytes_waiting_ -= jobs_.front().result->records.size();
    jobs_.pop_front();
  }
}

std::uint64_t RankScheduler::blocks_for(const Rank& rank) const {
  const std::uint64_t ranks = states_.size();
  const std::uint64_t share = std::max<std::uint64_t>(blocks_left_ / (kShare * ranks), rank.threads);
  if (rank.seconds_per_block <= 0.0) return std::min<std::uint64_t>(share, rank.threads);
  const double seconds = std::max(kJobSeconds, static_cast<double>(ranks) * pass_seconds_ / kPassingShare);
  double blocks =
      std::max(seconds / rank.seconds_per_block, static_cast<double>(kBlocksPerThread * rank.threads));
  if (rank.bytes_per_block > 0.0) blocks = std::min(blocks, kMostJobBytes / rank.bytes_per_block);
  blocks = std::min(blocks, static_cast<double>(share));
  return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(blocks));
}

void RankScheduler::hand_out() {
  for (int to = 0; to < ranks_.size(); ++to) {
    Rank& rank = states_[static_cast<std::size_t>(to)];
    while (rank.ready && rank.under_way < kJobsPerRank && !work_.empty() &&
           jobs_.size() < kMostWaitingPerRank * states_.size() && bytes_waiting_ < kMostWaitingBytes) {
      Work& work = work_.front();
      RankJob job{next_number_++, work.point, work.blocks};
      job.blocks.last = job.blocks.first + std::min(blocks_for(rank), work.blocks.count());
      if (next_division_) job.blocks.last = std::min(job.blocks.last, next_division_(job.blocks.first));
      work.blocks.first = job.blocks.last;
      blocks_left_ -= job.blocks.count();
      if (work.blocks.count() == 0) work_.pop_front();
      jobs_.push_back({job, to, std::nullopt});
      if (rank.under_way++ == 0) rank.heard = Clock::now();
      give(to, job);
    }
  }
}

void RankScheduler::give(int to, const RankJob& job) {
  if (to == 0)
    worker_.add(job, tracer_of_(job.point));
  else
    ranks_.send(to, message(job));
}

void RankScheduler::poll() {
  bool any = false;
  while (const std::optional<Ranks::Message> next = ranks_.receive()) {
    any = true;
    receive(*next);
  }
  std::optional<RankResult> own = worker_.take(any ? std::chrono::milliseconds(0) : kPatience);
  if (own) take(0, std::move(*own));
  expect_signs_of_life();
}

void RankScheduler::expect_signs_of_life() const {
  // All messages that have arrived were received, however long this rank was busy before.
  for (std::size_t rank = 1; rank < states_.size(); ++rank) {
    const Clock::duration silent = Clock::now() - states_[rank].heard;
    if (states_[rank].under_way == 0 || silent < patience_) continue;
    throw core::SystemError(fmt::format(
        "rank {} has not answered for {:.0f} s: its process hangs, or its machine or network is gone", rank,
        std::chrono::duration<double>(silent).count()));
  }
}

void RankScheduler::receive(const Ranks::Message& next) {
  Rank& rank = states_[static_cast<std::size_t>(next.from)];
  rank.heard = Clock::now();
  switch (kind_of(next.bytes)) {
    case MessageKind::ready: {
      RankReady ready;
      read_message(next.bytes, ready);
      const std::string other = difference(ready.run, run_);
      if (!other.empty())
        throw core::InputError({{},
                                fmt::format("rank {} would compute another run: {}", next.from, other),
                                "all ranks need the same scene, files and version of ScintRay"});
      rank.threads = std::max<std::uint32_t>(1, ready.threads);
      rank.ready = true;
      return;
    }
    case MessageKind::result: {
      RankResult result;
      read_message(next.bytes, result);
      return take(next.from, std::move(result));
    }
    case MessageKind::stop:
      stop_requested_ = true;
      return;
    case MessageKind::alive:
      return;
    case MessageKind::failed: {
      RankFailure failure;
      read_message(next.bytes, failure);
      failure.rethrow(next.from);
    }
    default:
      throw core::InternalError(fmt::format("a message from rank {} that is for others", next.from));
  }
}

void RankScheduler::take(int from, RankResult result) {
  Rank& rank = states_[static_cast<std::size_t>(from)];
  const std::uint64_t at = jobs_.empty() ? 0 : result.number - jobs_.front().job.number;
  if (at >= jobs_.size() || jobs_[at].rank != from || jobs_[at].result)
    throw core::InternalError(fmt::format("a result of rank {} for what it was not given", from));
  const RankJob& job = jobs_[at].job;
  if (result.last < job.blocks.first || result.last > job.blocks.last)
    throw core::InternalError(fmt::format("a result of rank {} for blocks that it was not given", from));
  --rank.under_way;
  if (const auto blocks = static_cast<double>(result.last - job.blocks.first); blocks > 0.0) {
    rank.seconds_per_block = result.seconds / blocks;
    rank.bytes_per_block = static_cast<double>(result.records.size()) / blocks;
  }
  bytes_waiting_ += result.records.size();
  jobs_[at].result = std::move(result);
}

bool RankScheduler::pass_on(std::size_t point, ResultSink& sink, const Passed& passed) {
  for (forget_dropped(); !jobs_.empty() && jobs_.front().result && jobs_.front().job.point == point;
       forget_dropped()) {
    const Clock::time_point start = Clock::now();
    Job job = std::move(jobs_.front());
    jobs_.pop_front();
    const std::size_t size = job.result->records.size();
    bytes_waiting_ -= size;
    StoredRange range;
    range.point = point;
    range.blocks = {job.job.blocks.first, job.result->last};
    if (range.blocks.count() > 0) {
      RecordReader records(fmt::format("rank {}", job.rank),
                           std::make_unique<std::istringstream>(std::move(job.result->records)), 0, size);
      const double seconds = std::chrono::duration<double>(start - last_passed_).count();
      last_passed_ = start;
      if (passed(replay_range(records, run_, range, {sink, false, seconds}))) drop(point);
    }
    pass_seconds_ = std::chrono::duration<double>(Clock::now() - start).count();
    if (range.blocks.last != job.job.blocks.last) return false;
  }
  return true;
}

bool RankScheduler::collect(std::size_t point, ResultSink& sink, const std::atomic<bool>* stop,
                            const Passed& passed) {
  std::optional<Clock::time_point> until;  // after a stop
  while (has_work(point)) {
    if (!until && ((stop && stop->load()) || stop_requested_)) {
      stop_ranks();
      until = Clock::now() + kStopPatience;
    }
    if (!until) hand_out();
    poll();
    if (!pass_on(point, sink, passed)) {
      if (!until) stop_ranks();
      return false;
    }
    const bool waits = !jobs_.empty() && !jobs_.front().result;
    if (until && (!waits || Clock::now() > *until)) return !has_work(point);
  }
  return true;
}

}  // namespace scintray::simulation::detail
