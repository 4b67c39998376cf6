#pragma once
/// The results file as a sink.

#include <filesystem>
#include <optional>

#include "scintray/results/results.hpp"
#include "scintray/simulation/analyze_results.hpp"
#include "scintray/simulation/result_sink.hpp"

namespace scintray::simulation {

/// Sink that writes a results file, with the analysis of its events. There is no file at its path before
/// commit().
class ResultsFile : public ResultSink {
 public:
  explicit ResultsFile(std::filesystem::path path) : path_(std::move(path)) {}

  /// Creates the file, so that a path that cannot be written is an error before hours of work.
  /// @throws InputError, SystemError as ResultsWriter
  void begin(const RunOutline& run) override;
  void surfaces(const std::vector<analysis::SurfaceAnalysis>& analyses) override;
  void paths(std::size_t point, const std::vector<tally::PhotonPath>& paths) override;
  void begin_events(std::size_t point, const std::vector<tally::ReadoutChannel>& channels,
                    const std::optional<detector::ReadoutSpec>& readout) override;
  void photons(const std::vector<tally::DetectedPhoton>& photons) override;
  void histories(const tally::PhotonHistories& histories, const tally::HistorySubjects& of_point) override;
  void events(const std::vector<tally::EventRecord>& events) override;
  void point(const tally::PointResult& result, const tally::HistorySubjects* histories) override;
  void commit(bool complete, const std::string& reason) override;

 private:
  std::filesystem::path path_;
  std::optional<results::ResultsWriter> writer_;
  std::optional<RunningAnalysis> analysis_;
};

}  // namespace scintray::simulation
