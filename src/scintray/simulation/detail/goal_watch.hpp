#pragma once
/// The result whose error ends a point, by [run] until.

#include <optional>
#include <string>
#include <vector>

#include "scintray/analysis/event_analysis.hpp"
#include "scintray/scene_file/until.hpp"
#include "scintray/simulation/simulation_point.hpp"
#include "scintray/tally/event_record.hpp"
#include "scintray/tally/point_sums.hpp"

namespace scintray::simulation::detail {

/// A bin of a tally, by their numbers.
struct TallyBin {
  std::size_t tally = 0, bin = 0;
};

/// The bin that a goal names; nothing where its result is no tally.
/// @throws InputError for a tally that does not exist, or a bin that it does not have
std::optional<TallyBin> goal_bin(const scene_file::UntilSpec& until, const tally::TallyPlan& plan);

/// Estimates the result that a goal names, from the sums over the blocks of a point and from its events.
class GoalWatch {
 public:
  /// @param point  with [run] until; outlives this
  explicit GoalWatch(const SimulationPoint& point);

  /// Name of the result, "share detected" or "CTR", and the unit of its absolute error: "1", "ns", ...
  const std::string& name() const { return name_; }
  const std::string& unit() const { return unit_; }
  /// Adds events, in their order; needed for results of events alone.
  void add(const std::vector<tally::EventRecord>& events);
  /// The result with its standard error, from all blocks and events so far; nothing when there are too few.
  std::optional<core::Estimate> estimate(const tally::PointSums& sums) const;
  /// True when enough was counted for a relative error to be relied on.
  bool is_known(const tally::PointSums& sums) const;

 private:
  std::optional<core::Estimate> estimate_of_events() const;

  const scene_file::UntilSpec& until_;
  double birth_efficiency_;
  std::optional<TallyBin> bin_;
  std::optional<analysis::EventCollector> events_;  ///< of a result of events
  std::string name_, unit_ = "1";
};

}  // namespace scintray::simulation::detail
