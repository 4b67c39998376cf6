#include "scintray/simulation/memory_sink.hpp"

#include <algorithm>

namespace scintray::simulation {

namespace {

template <typename T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

void MemorySink::begin(const RunOutline& run) {
  *this = MemorySink();
  outline = run;
  result.header = run.header;
  result.partial_reason = "not committed";
}

void MemorySink::surfaces(const std::vector<analysis::SurfaceAnalysis>& analyses) {
  surface_analyses = analyses;
}

void MemorySink::paths(std::size_t point, const std::vector<tally::PhotonPath>& paths) {
  path_list.resize(std::max(path_list.size(), point + 1));
  path_list[point] = paths;
}

void MemorySink::begin_events(std::size_t point, const std::vector<tally::ReadoutChannel>& channels,
                              const std::optional<detector::ReadoutSpec>& readout) {
  readouts.resize(std::max(readouts.size(), point + 1));
  readouts[point] = {channels, readout};
}

void MemorySink::photons(const std::vector<tally::DetectedPhoton>& photons) { append(photon_list, photons); }

void MemorySink::histories(const tally::PhotonHistories& histories, const tally::HistorySubjects& of_point) {
  if (histories.rows() == 0) return;
  const auto same_point = [&] { return history_list.back().rows.point.front() == histories.point.front(); };
  if (history_list.empty() || !same_point()) history_list.push_back({of_point, {}});
  tally::PhotonHistories& rows = history_list.back().rows;
  append(rows.point, histories.point);
  append(rows.event, histories.event);
  append(rows.photon, histories.photon);
  append(rows.path_mm, histories.path_mm);
  append(rows.absorption_depth, histories.absorption_depth);
  append(rows.reflections, histories.reflections);
  append(rows.reflection_depth, histories.reflection_depth);
}

void MemorySink::events(const std::vector<tally::EventRecord>& events) { append(event_list, events); }

void MemorySink::point(const tally::PointResult& result_of_point,
                       const tally::HistorySubjects* /*histories*/) {
  result.points.push_back(result_of_point);
}

void MemorySink::commit(bool complete, const std::string& reason) {
  result.partial_reason = complete ? std::string() : reason;
}

}  // namespace scintray::simulation
