#pragma once
/// Interface of a receiver of results during a run.

#include <optional>
#include <string>
#include <vector>

#include "scintray/analysis/goniometer/surface_analysis.hpp"
#include "scintray/core/input_file.hpp"
#include "scintray/detector/readout_spec.hpp"
#include "scintray/results/history_table.hpp"
#include "scintray/results/photon_list_layout.hpp"
#include "scintray/tally/event_record.hpp"
#include "scintray/tally/photon_history.hpp"
#include "scintray/tally/photon_path.hpp"
#include "scintray/tally/point_sums.hpp"
#include "scintray/tally/readout_channels.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::simulation {

/// Information about a point before its first photon.
struct PointOutline {
  std::vector<std::string> parameters;  ///< value of each swept key, as written
  std::uint64_t work = 0;               ///< photons, or events of an event source
  std::uint64_t blocks = 0;             ///< of photons or events
  std::uint64_t max_interactions = 0;   ///< boundary interactions after which a photon is cut
  std::optional<double> max_time_ns{};  ///< time after which a photon is cut
};

/// Information about a run before its first photon.
struct RunOutline {
  tally::RunHeader header;
  bool photon_list = false;                          ///< detected photons will be passed to the sink
  results::PhotonListLayout photons;                 ///< which of them, and what of each a file has
  bool paths = false;                                ///< paths of photons will be passed to the sink
  std::optional<results::HistoryColumns> histories;  ///< of all points; empty: there are none
  bool has_energy = false;                           ///< of an event source
  std::vector<PointOutline> points;
  std::vector<core::InputFile>
      inputs;  ///< files that were read: meshes, definitions, curves, height maps, hits
};

/// Blocks of one point.
struct PointRange {
  std::size_t point = 0;
  tally::BlockRange blocks;
  tally::PointFacts facts{};                          ///< of the point
  const tally::HistorySubjects* histories = nullptr;  ///< of the point; null when no histories are kept
};

/// Receiver of the results of a run, point after point. All indices are those of RunHeader. Each function
/// does nothing unless it is overridden, so that a sink receives only what it needs. All are called from one
/// thread at a time.
class ResultSink {
 public:
  ResultSink() = default;
  ResultSink(const ResultSink&) = default;
  ResultSink& operator=(const ResultSink&) = default;
  virtual ~ResultSink() = default;

  /// Called before all others, once.
  virtual void begin(const RunOutline& /*run*/) {}
  /// Readings of the scene's goniometers, once, when there are any.
  virtual void surfaces(const std::vector<analysis::SurfaceAnalysis>& /*studies*/) {}
  /// Recorded paths of photons of a point, before all else of it, where they are requested. Of shards, only
  /// the one with the point's first block has them.
  virtual void paths(std::size_t /*point*/, const std::vector<tally::PhotonPath>& /*paths*/) {}
  /// Readout of the events of a point, before the first of them; not called for a source of photons.
  virtual void begin_events(std::size_t /*point*/, const std::vector<tally::ReadoutChannel>& /*channels*/,
                            const std::optional<detector::ReadoutSpec>& /*readout*/) {}
  /// The next detected photons, in their order, when they are listed.
  virtual void photons(const std::vector<tally::DetectedPhoton>& /*photons*/) {}
  /// The next histories, in the order of the photons, when they are kept.
  virtual void histories(const tally::PhotonHistories& /*histories*/,
                         const tally::HistorySubjects& /*of_point*/) {}
  /// The next events of an event source, in their order.
  virtual void events(const std::vector<tally::EventRecord>& /*events*/) {}
  /// Sums over the next blocks of a point, after the photons, histories and events of these blocks. The
  /// ranges of a point follow each other without a gap, in a complete run from its first block to its last.
  virtual void range(const PointRange& /*of*/, const tally::PointSums& /*sums*/) {}
  /// A point, after all that belongs to it; no subjects (null) when no histories are kept.
  virtual void point(const tally::PointResult& /*result*/, const tally::HistorySubjects* /*histories*/) {}
  /// Called after all others, once, with the reason why the run is not complete; empty when it is.
  virtual void commit(bool /*complete*/, const std::string& /*reason*/) {}
};

}  // namespace scintray::simulation
