#pragma once
/// Receiver of the blocks of one point.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/simulation/result_sink.hpp"

namespace scintray::simulation {

/// Receiver of the blocks of one point: passes them on to the sink of the run, and to a second one where
/// there is one, and sums them up.
class PointSink : public ResultSink {
 public:
  explicit PointSink(ResultSink& to) : to_(to) {}

  void photons(const std::vector<tally::DetectedPhoton>& photons) override {
    to_.photons(photons);
    if (also) also->photons(photons);
  }
  void histories(const tally::PhotonHistories& histories, const tally::HistorySubjects& of_point) override {
    to_.histories(histories, of_point);
    if (also) also->histories(histories, of_point);
  }
  void events(const std::vector<tally::EventRecord>& events) override {
    if (watch_events) watch_events(events);
    to_.events(events);
    if (also) also->events(events);
  }
  void range(const PointRange& of, const tally::PointSums& sums) override {
    to_.range(of, sums);
    if (also) also->range(of, sums);
    if (total && !total->alike(sums))
      throw core::InputError(
          {{}, "the tallies of a checkpoint are not those of this run", "add --restart to begin anew"});
    if (total)
      total->merge(sums);
    else
      total = sums;
    blocks = of.blocks.last;
  }

  ResultSink* also = nullptr;
  std::optional<std::uint64_t> expected_work;  ///< photons or events, where it is not that of the source
  std::string error_text;                      ///< of [run] until: what was reached of an error
  std::optional<tally::UntilResult> until;     ///< with [run] until
  std::function<void(const std::vector<tally::EventRecord>&)> watch_events;  ///< before they are passed on
  std::uint64_t blocks = 0;               ///< one past the last of the ranges so far
  std::optional<tally::PointSums> total;  ///< over the ranges so far; nothing before the first

 private:
  ResultSink& to_;
};

}  // namespace scintray::simulation
