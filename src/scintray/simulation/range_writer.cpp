#include "scintray/core/zlib_stream.hpp"
#include "scintray/simulation/detail/range_stream.hpp"

namespace scintray::simulation::detail {

namespace {

/// Bytes of rows that are held before they are written as a record.
constexpr std::size_t kRowBytes = 1 << 20;

}  // namespace

void RangeWriter::write(Record record, std::string_view content) {
  const std::string head =
      encoded(static_cast<std::uint8_t>(record), static_cast<std::uint64_t>(content.size()));
  put_(head);
  put_(content);
  put_(encoded(core::crc32(content, core::crc32(head))));
}

void RangeWriter::write_rows(Record record, Encoder& rows, std::size_t least) {
  if (rows.bytes.size() <= least) return;
  write(record, rows.bytes);
  rows.bytes.clear();
}

void RangeWriter::write_readout() {
  if (!has_readout_ && !readout_.empty()) write(Record::readout, readout_);
  has_readout_ = true;
}

void RangeWriter::write_paths() {
  if (!paths_.empty()) write(Record::paths, paths_);
  paths_.clear();
}

void RangeWriter::surfaces(const std::vector<analysis::SurfaceAnalysis>& analyses) {
  write(Record::surfaces, encoded(analyses));
}

void RangeWriter::paths(std::size_t point, const std::vector<tally::PhotonPath>& paths) {
  paths_ = encoded(static_cast<std::uint64_t>(point), paths);
}

void RangeWriter::begin_events(std::size_t point, const std::vector<tally::ReadoutChannel>& channels,
                               const std::optional<detector::ReadoutSpec>& readout) {
  readout_ = encoded(static_cast<std::uint64_t>(point), channels, readout);
}

void RangeWriter::photons(const std::vector<tally::DetectedPhoton>& photons) {
  write_paths();
  for (tally::DetectedPhoton photon : photons) photon_rows_.exchange(photons_, photon);
  write_rows(Record::photons, photons_, kRowBytes);
}

void RangeWriter::histories(const tally::PhotonHistories& histories, const tally::HistorySubjects& of_point) {
  write_paths();
  if (!has_subjects_) write(Record::subjects, encoded(of_point));
  has_subjects_ = true;
  tally::PhotonHistories rows = histories;
  pass(histories_, rows);
  write_rows(Record::histories, histories_, kRowBytes);
}

void RangeWriter::events(const std::vector<tally::EventRecord>& events) {
  write_paths();
  write_readout();
  for (tally::EventRecord event : events) pass(events_, event);
  write_rows(Record::events, events_, kRowBytes);
}

void RangeWriter::range(const PointRange& of, const tally::PointSums& sums) {
  write_paths();
  if (of.histories && !has_subjects_) write(Record::subjects, encoded(*of.histories));
  write_readout();
  has_subjects_ = has_readout_ = false;
  write_rows(Record::photons, photons_, 0);
  write_rows(Record::histories, histories_, 0);
  write_rows(Record::events, events_, 0);
  write(Record::range, encoded(static_cast<std::uint64_t>(of.point), of.blocks, of.facts, sums));
}

}  // namespace scintray::simulation::detail
