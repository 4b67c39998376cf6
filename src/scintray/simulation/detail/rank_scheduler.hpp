#pragma once
/// Distribution of the blocks of a run over ranks, by rank 0.

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "scintray/simulation/detail/rank_work.hpp"
#include "scintray/simulation/range_file.hpp"

namespace scintray::simulation::detail {

/// Hands block ranges out to ranks that have little left to do, its own among them, and passes their results
/// on in the order of points and blocks. Ranges are long enough that messages and merging take little of the
/// time, and shorter towards the end of the run, so that all ranks end together. No result depends on how
/// blocks are divided.
class RankScheduler {
 public:
  /// Blocks of a point that are to be traced.
  struct Work {
    std::size_t point = 0;
    tally::BlockRange blocks;
  };
  /// Returns what traces jobs of a point in this process.
  using TracerOf = std::function<TraceJob(std::size_t point)>;

  /// @param work     in the order of points
  /// @param threads  of this rank
  RankScheduler(Ranks& ranks, const RunOutline& run, std::vector<Work> work, TracerOf tracer_of,
                std::uint32_t threads);
  RankScheduler(const RankScheduler&) = delete;
  RankScheduler& operator=(const RankScheduler&) = delete;

  /// No job goes beyond the first block count that this returns for its first block; for runs that decide at
  /// fixed block counts when to end.
  void divide_at(std::function<std::uint64_t(std::uint64_t first)> next) { next_division_ = std::move(next); }
  /// Ends the run (SystemError) when a rank that has jobs sends nothing for so long.
  void set_patience(std::chrono::milliseconds patience) { patience_ = patience; }
  /// Drops the blocks of a point that were not passed on.
  void drop(std::size_t point);

  /// Called after each range; true when the point needs no more blocks: those left are dropped.
  using Passed = std::function<bool(const RangeReader::Content&)>;
  /// Passes the results of a point's blocks on. Ranks trace blocks of the points after it meanwhile.
  /// @param stop  set from outside: the blocks under way are finished, and no more begun; may be null
  /// @return true when all blocks of the point have been passed on or dropped; false after a stop
  /// @throws InputError, SystemError, InternalError of any rank, with its number
  bool collect(std::size_t point, ResultSink& sink, const std::atomic<bool>* stop, const Passed& passed);

 private:
  using Clock = std::chrono::steady_clock;
  struct Job {
    RankJob job;
    int rank = 0;
    std::optional<RankResult> result;
    bool dropped = false;  ///< its result is not needed
  };
  struct Rank {
    std::uint32_t threads = 1;
    bool ready = false;
    int under_way = 0;               ///< jobs
    double seconds_per_block = 0.0;  ///< of the latest job; 0 before
    double bytes_per_block = 0.0;
    Clock::time_point heard = Clock::now();  ///< latest message, or begin of a time with jobs
  };

  bool has_work(std::size_t point) const;
  std::uint64_t blocks_for(const Rank& rank) const;
  void hand_out();
  void give(int to, const RankJob& job);
  /// Receives messages and results; waits for one a short time.
  void poll();
  void receive(const Ranks::Message& message);
  /// @throws SystemError for a rank that has been silent for too long
  void expect_signs_of_life() const;
  void take(int from, RankResult result);
  /// Passes the results on that are there without a gap. Returns false after a range that was stopped.
  bool pass_on(std::size_t point, ResultSink& sink, const Passed& passed);
  /// Removes the jobs at the front that were dropped and have come back.
  void forget_dropped();
  void stop_ranks();

  Ranks& ranks_;
  const RunOutline& run_;
  std::deque<Work> work_;          ///< not yet assigned
  std::uint64_t blocks_left_ = 0;  ///< in work_
  TracerOf tracer_of_;
  std::function<std::uint64_t(std::uint64_t)> next_division_;
  std::vector<Rank> states_;
  std::deque<Job> jobs_;  ///< assigned, and results not yet passed on
  std::uint64_t next_number_ = 0;
  std::size_t bytes_waiting_ = 0;  ///< of results that wait for others before them
  double pass_seconds_ = 0.0;      ///< that it took to pass the latest result on
  Clock::time_point last_passed_ = Clock::now();
  bool stop_requested_ = false;
  std::chrono::milliseconds patience_{60'000};
  RankWorker worker_;
};

}  // namespace scintray::simulation::detail
