#pragma once
/// Decision when a point has enough photons, by [run] until.

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "scintray/scene_file/until.hpp"
#include "scintray/simulation/detail/goal_watch.hpp"
#include "scintray/simulation/result_sink.hpp"
#include "scintray/tally/point_sums.hpp"

namespace scintray::simulation::detail {

/// The least number of blocks, above `blocks`, after which errors and counts are compared with their goals:
/// 4 blocks of photons or 32 events, and from there on a tenth more each time, so that a run has at most a
/// tenth more than it needs. The numbers are fixed: no result depends on threads, ranks or checkpoints.
std::uint64_t next_decision(std::uint64_t blocks, bool has_energy);

/// Follows the sums over the blocks of a point, and its events, and decides when they are enough.
class UntilWatch {
 public:
  /// @param point    with [run] until; outlives this
  /// @param seconds  share of the wall time for this point; infinite without one
  UntilWatch(const SimulationPoint& point, double seconds);

  /// True when look() is to be called after so many blocks.
  bool is_due(std::uint64_t blocks) const;
  /// Adds events of the point, before look() at the sums of their blocks.
  void add(const std::vector<tally::EventRecord>& events) { goal_.add(events); }
  /// Decides by the sums over the first `blocks`. Errors and counts are decided by at fixed numbers of
  /// blocks alone, time at any.
  void look(std::uint64_t blocks, const tally::PointSums& sums);
  bool has_ended() const { return ended_; }
  /// Photons or events that the point is expected to take in all, from the latest decision.
  std::uint64_t expected_work() const { return expected_; }
  /// The error of the latest decision and its goal, as "error 1.2 %, goal 0.5 %"; empty without such a goal.
  std::string error_text() const;
  /// Goals, and what was reached, of sums over all blocks of the point.
  tally::UntilResult result(const tally::PointSums& sums) const;

 private:
  using Clock = std::chrono::steady_clock;

  double elapsed_s() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  const scene_file::UntilSpec& spec_;
  GoalWatch goal_;
  bool has_energy_;
  std::uint64_t work_;  ///< photons or events of the source
  double seconds_;
  Clock::time_point start_ = Clock::now();
  bool ended_ = false;
  std::uint64_t expected_;
  tally::UntilResult last_;  ///< of the latest decision
};

/// Shares of the wall time of a run for its points, of sum 1, so that the relative errors of the result that
/// ends them come out alike: the error of a point falls with the root of its time, so its share is the
/// square of the error that it had after a short time, times that time.
/// @param seconds, errors  of the same points; an error of 0 is not known, and taken as the mean of the
/// others
std::vector<double> time_shares(const std::vector<double>& seconds, const std::vector<double>& errors);

}  // namespace scintray::simulation::detail
