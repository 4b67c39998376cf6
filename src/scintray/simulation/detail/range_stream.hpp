#pragma once
/// Records of block ranges as a stream of bytes: of files, and of messages between the ranks of a run.

#include <filesystem>
#include <functional>
#include <istream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scintray/simulation/detail/photon_rows.hpp"
#include "scintray/simulation/detail/range_records.hpp"
#include "scintray/simulation/range_file.hpp"

namespace scintray::simulation::detail {

/// Sink that passes the records of block ranges on as bytes. It writes neither the head of a file nor its
/// end.
class RangeWriter : public ResultSink {
 public:
  using Put = std::function<void(std::string_view bytes)>;

  /// @param photons  columns of the list of photons that are stored
  explicit RangeWriter(Put put, const results::PhotonListLayout& photons = {})
      : put_(std::move(put)), photon_rows_(photons) {}

  void write(Record record, std::string_view content);

  void surfaces(const std::vector<analysis::SurfaceAnalysis>& analyses) override;
  void paths(std::size_t point, const std::vector<tally::PhotonPath>& paths) override;
  void begin_events(std::size_t point, const std::vector<tally::ReadoutChannel>& channels,
                    const std::optional<detector::ReadoutSpec>& readout) override;
  void photons(const std::vector<tally::DetectedPhoton>& photons) override;
  void histories(const tally::PhotonHistories& histories, const tally::HistorySubjects& of_point) override;
  void events(const std::vector<tally::EventRecord>& events) override;
  void range(const PointRange& of, const tally::PointSums& sums) override;

 private:
  void write_rows(Record record, Encoder& rows, std::size_t least);
  /// Writes the readout of the events of the present range, once.
  void write_readout();
  /// Writes the paths that wait, before all other rows of their range.
  void write_paths();

  Put put_;
  PhotonRows photon_rows_;
  Encoder photons_, histories_, events_;  ///< rows of the present range that wait to be written
  bool has_subjects_ = false;             ///< of the present range
  std::string readout_;                   ///< record of the present point; empty for a source of photons
  bool has_readout_ = false;              ///< in the present range
  std::string paths_;                     ///< record that waits for the first range of its point
};

/// Beginning of a kind of file of records, and words for messages about others.
struct FileHead {
  std::string_view magic;  ///< first bytes; the version of the layout follows
  std::uint32_t version = 0;
  std::string_view name;          ///< "this shard of a response map"
  std::string_view no_file_hint;  ///< for a folder
  std::string_view other;         ///< "this is not ..."
  std::string_view other_hint;

  std::size_t size() const { return magic.size() + sizeof version; }
};

/// Size of a file, bytes, with this head. @throws InputError for any other, SystemError for what cannot be
/// read
std::uint64_t checked_size(const std::filesystem::path& path, const FileHead& head);

/// Reader of records, one after the other.
class RecordReader {
 public:
  /// @param name  of the file, or of what sent the bytes, for messages
  /// @param from, to  positions of the records in the stream, bytes
  RecordReader(std::filesystem::path name, std::unique_ptr<std::istream> stream, std::uint64_t from,
               std::uint64_t to);

  std::uint64_t position() const { return at_; }
  bool at_end() const { return at_ == end_; }
  const std::string& content() const { return content_; }
  /// The error for bytes that are not what was written.
  core::InputError damaged() const;

  /// Reads the next record. @throws InputError for one that is not what was written, as all members do
  Record next();

  /// Values of the record, all of it.
  template <typename... T>
  void decode(T&... values) const {
    try {
      Decoder decoder(content_);
      detail::pass(decoder, values...);
      if (!decoder.at_end()) throw Undecodable();
    } catch (const Undecodable&) {
      throw damaged();
    }
  }

  /// Rows of the record, each of which is passed on.
  template <typename Row>
  std::vector<Row> rows() const {
    return rows(Row(), [](Decoder& decoder, Row& row) { detail::pass(decoder, row); });
  }
  /// The same where `read(decoder, row)` sets members of a row that is otherwise `absent`. Each has bytes.
  template <typename Row, typename Read>
  std::vector<Row> rows(const Row& absent, const Read& read) const {
    std::vector<Row> rows;
    try {
      Decoder decoder(content_);
      while (!decoder.at_end()) read(decoder, rows.emplace_back(absent));
    } catch (const Undecodable&) {
      throw damaged();
    }
    return rows;
  }

 private:
  std::string read(std::uint64_t bytes);

  std::filesystem::path name_;
  std::unique_ptr<std::istream> stream_;
  std::uint64_t at_, end_;
  std::string content_;
};

/// Where the records of a range go.
struct RangeTarget {
  ResultSink& sink;
  bool begins = false;                      ///< with begin_events, for the first range of a point
  std::optional<double> wall_seconds = {};  ///< replaces that of the range
};

/// Passes the records of one range, to the end of the reader, on.
/// @param of  the blocks that they are of
/// @throws InputError for records that are not of these blocks, or not of this run
RangeReader::Content replay_range(RecordReader& records, const RunOutline& run, const StoredRange& of,
                                  const RangeTarget& target);

}  // namespace scintray::simulation::detail
