#pragma once
/// Tally of the photons of one block.

#include <cstdint>
#include <optional>
#include <vector>

#include "scintray/source/photon_records.hpp"
#include "scintray/tally/count_scorer.hpp"
#include "scintray/tally/point_sums.hpp"
#include "scintray/tally/result.hpp"
#include "scintray/tally/tally_plan.hpp"
#include "scintray/transport/step.hpp"

namespace scintray::tally {

/// Counts of one block of photons. A block is traced by one thread in the order of its photons, and sums over
/// blocks are exact (PointSums), so that results depend neither on threads nor on who traced which block.
class BlockTally {
 public:
  explicit BlockTally(const scene::Scene& scene, const TallyPlan& plan);

  /// Starts the record of a photon, in its state at emission.
  void start(const source::Photon& emitted, std::uint64_t event, std::uint64_t photon);
  /// Side tables of the present photon, filled while it is traced.
  source::PhotonRecords& records() { return records_; }
  /// Records a total reflection passed before the next step. Requires wants_reflections().
  void pass(const source::Photon& photon, const transport::Step& step) { scorer_->step(photon, step); }
  bool wants_reflections() const { return plan_.follows_reflections; }
  /// Records a step that is not the photon's last.
  void record(const source::Photon& photon, const transport::Step& step) {
    count_step(step);
    if (scorer_) scorer_->step(photon, step);
    if (history_) history_->step(photon, step);
  }
  /// Starts a photon of which only the end is recorded.
  void start(std::uint64_t event, std::uint64_t photon) {
    event_ = event;
    photon_ = photon;
    records_.clear();
  }
  /// Records the segments, and ray queries resolved by the exact query, of steps that are no photon's last.
  void count_steps(std::uint64_t segments, std::uint64_t resolved) {
    result_.segments += segments;
    result_.resolved_misses += resolved;
  }
  /// Records the end of the photon: by its last step, or by a limit.
  void end(const source::Photon& photon, const transport::Step& step, std::uint32_t point);
  void cut(const source::Photon& photon, core::Fate fate);

  const PointResult& result() const { return result_; }
  const std::vector<DetectedPhoton>& photons() const { return photons_; }
  /// Histories of the detected photons; null when none are requested.
  const PhotonHistories* histories() const { return history_ ? &history_->kept() : nullptr; }
  /// Adds the block to the sums over others.
  /// @param is_event  the block is one event of an event source, the photons of which are not independent
  void add_to(PointSums& total, bool is_event) const;

 private:
  void count_step(const transport::Step& step) { count_steps(step.segments, step.resolved); }
  void finish(const source::Photon& photon, core::Fate fate);

  const TallyPlan& plan_;
  PointResult result_;
  source::PhotonRecords records_;
  std::vector<DetectedPhoton> photons_;
  std::optional<CountScorer> scorer_;       ///< when the plan has counts
  std::optional<HistoryRecorder> history_;  ///< when the plan has histories
  std::uint64_t event_ = 0, photon_ = 0;
};

/// Sums over no blocks, with the right sizes.
PointSums empty_sums(const scene::Scene& scene, const TallyPlan& plan);

}  // namespace scintray::tally
