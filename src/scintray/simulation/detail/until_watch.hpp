#pragma once
/// Decision when a point has enough photons, by [run] until.

#include <chrono>
#include <cstdint>

#include "scintray/scene_file/until.hpp"
#include "scintray/simulation/result_sink.hpp"
#include "scintray/tally/point_sums.hpp"

namespace scintray::simulation::detail {

/// The least number of blocks, above `blocks`, after which errors and counts are compared with their goals:
/// 4 blocks of photons or 32 events, and from there on a tenth more each time, so that a run has at most a
/// tenth more than it needs. The numbers are fixed: no result depends on threads, ranks or checkpoints.
std::uint64_t next_decision(std::uint64_t blocks, bool has_energy);

/// Follows the sums over the blocks of a point and decides when they are enough.
class UntilWatch {
 public:
  /// @param point            of a run that has them all
  /// @param seconds          share of the wall time for this point; infinite without one
  UntilWatch(const scene_file::UntilSpec& spec, const RunOutline& run, std::size_t point, double seconds,
             double birth_efficiency);

  /// True when look() is to be called after so many blocks.
  bool is_due(std::uint64_t blocks) const;
  /// Decides by the sums over the first `blocks`. Errors and counts are decided by at fixed numbers of
  /// blocks alone, time at any.
  void look(std::uint64_t blocks, const tally::PointSums& sums);
  bool has_ended() const { return ended_; }
  /// Photons or events that the point is expected to take in all, from the latest decision.
  std::uint64_t expected_work() const { return expected_; }
  /// Goals, and what was reached, of sums over all blocks of the point.
  tally::UntilResult result(const tally::PointSums& sums) const;

 private:
  using Clock = std::chrono::steady_clock;

  double elapsed_s() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  scene_file::UntilSpec spec_;
  bool has_energy_;
  std::uint64_t work_;  ///< photons or events of the source
  double seconds_, birth_efficiency_;
  Clock::time_point start_ = Clock::now();
  bool ended_ = false;
  std::uint64_t expected_;
  tally::UntilResult last_;  ///< of the latest look
};

}  // namespace scintray::simulation::detail
