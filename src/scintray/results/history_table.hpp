#pragma once
/// The table of photon histories of a results file, and the optics with which its points were traced.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scintray/core/h5.hpp"
#include "scintray/tally/photon_history.hpp"

namespace scintray::results {

/// Media and reflectors of all points of a run: columns of the table.
struct HistoryColumns {
  std::vector<std::string> media;
  std::vector<tally::ReflectorSite> reflectors;
  std::vector<std::string> transmitting, gap_media;

  /// Adds the media and reflectors of a point that are new.
  void add(const tally::HistorySubjects& point);
};

/// Writer of histories during a run; rows are written in blocks, so memory is bounded.
class HistoryWriter {
 public:
  HistoryWriter(core::h5::Group& root, HistoryColumns columns);

  /// Appends photons of a point, in the point's own columns.
  void add(const tally::PhotonHistories& rows, const tally::HistorySubjects& point);
  void write_waiting();
  /// Writes the optics of a point, as traced, into its group.
  void describe_point(core::h5::Group& point, const tally::HistorySubjects& subjects) const;

 private:
  core::h5::Group group_;
  HistoryColumns columns_;
  tally::PhotonHistories waiting_;
  std::size_t block_rows_;
  std::uint64_t written_ = 0;  ///< rows in the file
};

/// Optics of one point as traced, in the columns of the run: not a number where the point has no such medium
/// or reflector.
struct TracedOptics {
  std::vector<tally::TracedRange> absorption_per_mm;  ///< per medium
  std::vector<tally::TracedRange> reflectance;        ///< per reflector
};

/// Reader of the histories of a results file.
class HistoryReader {
 public:
  /// Throws InputError when the file is not a result that this program reads, or has no histories.
  explicit HistoryReader(const std::filesystem::path& path);

  const HistoryColumns& columns() const { return columns_; }
  std::uint64_t rows() const { return rows_; }
  /// At most `count` rows from `offset` on. Throws InputError when the file is inconsistent.
  tally::PhotonHistories read(std::uint64_t offset, std::uint64_t count) const;
  /// Optics of a point as traced; empty for a point without histories.
  std::optional<TracedOptics> traced(std::size_t point) const;

 private:
  std::filesystem::path path_;
  core::h5::File file_;
  core::h5::Group group_;
  HistoryColumns columns_;
  std::uint64_t rows_ = 0;
};

}  // namespace scintray::results
