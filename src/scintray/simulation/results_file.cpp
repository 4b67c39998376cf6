#include "scintray/simulation/results_file.hpp"

namespace scintray::simulation {

void ResultsFile::begin(const RunOutline& run) {
  writer_.emplace(path_, run.header, false);
  if (run.photon_list) writer_->begin_photons(run.photons);
  analysis_.emplace(run.header);
  if (run.paths) writer_->begin_paths();
  if (run.histories) writer_->begin_histories(*run.histories);
}

void ResultsFile::surfaces(const std::vector<analysis::SurfaceAnalysis>& analyses) {
  writer_->add_surfaces(analyses);
}

void ResultsFile::paths(std::size_t point, const std::vector<tally::PhotonPath>& paths) {
  writer_->append_paths(point, paths);
}

void ResultsFile::begin_events(std::size_t point, const std::vector<tally::ReadoutChannel>& channels,
                               const std::optional<detector::ReadoutSpec>& readout) {
  writer_->begin_events(point, channels, readout);
  analysis_->begin_point(channels, readout);
}

void ResultsFile::photons(const std::vector<tally::DetectedPhoton>& photons) {
  writer_->append_photons(photons);
}

void ResultsFile::histories(const tally::PhotonHistories& histories, const tally::HistorySubjects& of_point) {
  writer_->append_histories(histories, of_point);
}

void ResultsFile::events(const std::vector<tally::EventRecord>& events) {
  writer_->append_events(events);
  analysis_->add(events);
}

void ResultsFile::point(const tally::PointResult& result, const tally::HistorySubjects* histories) {
  const std::optional<analysis::EventAnalysis> analysis = analysis_->finish_point(result);
  writer_->add_point(result, histories, analysis ? &*analysis : nullptr);
}

void ResultsFile::commit(bool complete, const std::string& reason) { writer_->commit(complete, reason); }

}  // namespace scintray::simulation
