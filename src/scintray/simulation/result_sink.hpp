#pragma once
/// Where the results of a run go while it goes on.

#include <optional>
#include <string>
#include <vector>

#include "scintray/analysis/goniometer/surface_analysis.hpp"
#include "scintray/detector/readout_spec.hpp"
#include "scintray/results/history_table.hpp"
#include "scintray/tally/event_record.hpp"
#include "scintray/tally/photon_history.hpp"
#include "scintray/tally/readout_channels.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::simulation {

/// What is known of a run before its first photon.
struct RunOutline {
  tally::RunHeader header;
  bool photon_list = false;                          ///< detected photons will come one by one
  std::optional<results::HistoryColumns> histories;  ///< of all points; nothing: there are none
};

/// Takes the results of a run, point after point. All indices are those of RunHeader. Each function does
/// nothing unless it is overridden, so that a sink takes what it is for. All are called from one thread at a
/// time.
class ResultSink {
 public:
  ResultSink() = default;
  ResultSink(const ResultSink&) = default;
  ResultSink& operator=(const ResultSink&) = default;
  virtual ~ResultSink() = default;

  /// Before all others, once.
  virtual void begin(const RunOutline& /*run*/) {}
  /// Surfaces of the scene's goniometers, once, when there are any.
  virtual void surfaces(const std::vector<analysis::SurfaceAnalysis>& /*studies*/) {}
  /// What the events of a point are read out by, before the first of them; for a source of photons never.
  virtual void begin_events(std::size_t /*point*/, const std::vector<tally::ReadoutChannel>& /*channels*/,
                            const std::optional<detector::ReadoutSpec>& /*readout*/) {}
  /// The next detected photons, in their order, when they are listed.
  virtual void photons(const std::vector<tally::DetectedPhoton>& /*photons*/) {}
  /// The next histories, in the order of the photons, when they are kept.
  virtual void histories(const tally::PhotonHistories& /*histories*/,
                         const tally::HistorySubjects& /*of_point*/) {}
  /// The next events of a source of energy, in their order.
  virtual void events(const std::vector<tally::EventRecord>& /*events*/) {}
  /// A point, after all that belongs to it; no subjects (null) when no histories are kept.
  virtual void point(const tally::PointResult& /*result*/, const tally::HistorySubjects* /*histories*/) {}
  /// After all others, once, with the reason why the run is not complete; empty when it is.
  virtual void commit(bool /*complete*/, const std::string& /*reason*/) {}
};

}  // namespace scintray::simulation
