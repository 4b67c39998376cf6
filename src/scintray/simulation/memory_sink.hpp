#pragma once
/// The results of a run in memory.

#include "scintray/simulation/result_sink.hpp"

namespace scintray::simulation {

/// Sink that keeps the content of a results file. The lists grow with the run: a photon takes 64 bytes, an
/// event 64 and 40 for each channel.
class MemorySink : public ResultSink {
 public:
  /// Readout of one point; empty for a source of photons.
  struct PointReadout {
    std::vector<tally::ReadoutChannel> channels;
    std::optional<detector::ReadoutSpec> readout;
  };
  /// Histories of one point, in columns of its own.
  struct PointHistories {
    tally::HistorySubjects subjects;
    tally::PhotonHistories rows;
  };

  RunOutline outline;
  tally::RunResult result;  ///< complete() is false until a complete run is committed
  std::vector<analysis::SurfaceAnalysis> surface_analyses;
  std::vector<PointReadout> readouts;  ///< per point
  std::vector<tally::DetectedPhoton> photon_list;
  std::vector<tally::EventRecord> event_list;
  std::vector<PointHistories> history_list;               ///< per point that has any, in order
  std::vector<std::vector<tally::PhotonPath>> path_list;  ///< per point; empty when none are recorded

  void begin(const RunOutline& run) override;
  void surfaces(const std::vector<analysis::SurfaceAnalysis>& analyses) override;
  void paths(std::size_t point, const std::vector<tally::PhotonPath>& paths) override;
  void begin_events(std::size_t point, const std::vector<tally::ReadoutChannel>& channels,
                    const std::optional<detector::ReadoutSpec>& readout) override;
  void photons(const std::vector<tally::DetectedPhoton>& photons) override;
  void histories(const tally::PhotonHistories& histories, const tally::HistorySubjects& of_point) override;
  void events(const std::vector<tally::EventRecord>& events) override;
  void point(const tally::PointResult& result_of_point, const tally::HistorySubjects* histories) override;
  void commit(bool complete, const std::string& reason) override;
};

}  // namespace scintray::simulation
