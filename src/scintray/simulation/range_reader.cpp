#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "scintray/core/zlib_stream.hpp"
#include "scintray/simulation/detail/byte_archive.hpp"
#include "scintray/simulation/detail/range_records.hpp"
#include "scintray/simulation/range_file.hpp"

namespace scintray::simulation {

using detail::Decoder;
using detail::Record;
using detail::Undecodable;

namespace {

core::InputError damaged(const std::filesystem::path& path) {
  return core::InputError({{path.string()},
                           "this file of block ranges is damaged or was not written to its end",
                           "copy it again from where it was made, or compute its blocks again"});
}

/// Reader of the records of an opened file, one after the other.
class RecordStream {
 public:
  RecordStream(const std::filesystem::path& path, std::uint64_t from, std::uint64_t to)
      : path_(path), file_(path, std::ios::binary), at_(from), end_(to) {
    if (!file_.seekg(static_cast<std::streamoff>(from))) throw damaged(path);
  }

  std::uint64_t position() const { return at_; }
  bool at_end() const { return at_ == end_; }
  const std::string& content() const { return content_; }

  /// Reads the next record. @throws InputError for one that is not what was written
  Record next() {
    std::string head = read(detail::kRecordHead);
    std::uint8_t kind = 0;
    std::uint64_t length = 0;
    Decoder decoder(head);
    detail::pass(decoder, kind, length);
    if (length > end_ - at_) throw damaged(path_);
    content_ = read(length);
    std::uint32_t sum = 0;
    const std::string tail = read(detail::kRecordTail);
    Decoder(tail).plain(sum);
    if (sum != core::crc32(content_, core::crc32(head))) throw damaged(path_);
    return static_cast<Record>(kind);
  }

  /// Values of the record, all of it.
  template <typename... T>
  void decode(T&... values) const {
    try {
      Decoder decoder(content_);
      detail::pass(decoder, values...);
      if (!decoder.at_end()) throw Undecodable();
    } catch (const Undecodable&) {
      throw damaged(path_);
    }
  }

  /// Rows of the record, each of which is passed on.
  template <typename Row>
  std::vector<Row> rows() const {
    std::vector<Row> rows;
    try {
      Decoder decoder(content_);
      while (!decoder.at_end()) detail::pass(decoder, rows.emplace_back());
    } catch (const Undecodable&) {
      throw damaged(path_);
    }
    return rows;
  }

 private:
  std::string read(std::uint64_t bytes) {
    if (bytes > end_ - at_) throw damaged(path_);
    std::string text(bytes, '\0');
    if (!file_.read(text.data(), static_cast<std::streamsize>(bytes))) throw damaged(path_);
    at_ += bytes;
    return text;
  }

  const std::filesystem::path& path_;
  std::ifstream file_;
  std::uint64_t at_, end_;
  std::string content_;
};

/// Size of a file of block ranges. @throws InputError for what is none
std::uint64_t checked_size(const std::filesystem::path& path) {
  const auto wrong = [&](const std::string& what, const std::string& hint) {
    return core::InputError({{path.string()}, what, hint});
  };
  std::error_code error;
  if (!std::filesystem::exists(path, error))
    throw wrong("there is no such file", "check the name and the folder");
  if (!std::filesystem::is_regular_file(path, error))
    throw wrong("this is not a file", "name the file of a shard, or a folder of checkpoints");
  if (::access(path.c_str(), R_OK) != 0)
    throw core::SystemError(path.string() + ": cannot read: " + std::strerror(errno));
  const std::uint64_t size = std::filesystem::file_size(path, error);
  std::ifstream file(path, std::ios::binary);
  std::string magic(detail::kMagic.size(), '\0'), version(sizeof(std::uint32_t), '\0');
  file.read(magic.data(), static_cast<std::streamsize>(magic.size()));
  file.read(version.data(), static_cast<std::streamsize>(version.size()));
  if (!file || magic != detail::kMagic)
    throw wrong("this is not a shard or checkpoint of a run", "name files that `scintray run --shard` wrote");
  std::uint32_t layout = 0;
  Decoder(version).plain(layout);
  if (layout != detail::kRangesVersion)
    throw wrong("this file of block ranges has layout " + std::to_string(layout) +
                    ", and this program reads " + std::to_string(detail::kRangesVersion),
                "use the version of ScintRay that wrote it");
  return size;
}

/// Sums over blocks, with the position in the file.
struct RangeRecord {
  std::uint64_t point = 0;
  tally::BlockRange blocks;
  tally::PointFacts facts;
  tally::PointSums sums;
};

RangeRecord read_range(const RecordStream& records) {
  RangeRecord range;
  records.decode(range.point, range.blocks, range.facts, range.sums);
  return range;
}

template <typename Id, typename T>
bool within(Id id, const core::IdVector<Id, T>& names) {
  return !id.has_value() || id.index() < names.size();
}

/// True when the sums refer to what the run has, so that whoever reads them finds every name and bin.
bool is_consistent(const tally::PointSums& sums, const tally::RunHeader& header) {
  const auto has_names = [&](const tally::SensorFaceCount& count) {
    return count.part.has_value() && count.face.has_value() && within(count.part, header.parts) &&
           within(count.face, header.faces);
  };
  const auto has_bins = [](const tally::TallySums& tally) {
    const std::size_t filled = tally.counts.empty() ? tally.sums.size() : tally.counts.size();
    std::size_t bins = 1;
    for (const tally::TallyAxis& axis : tally.empty.axes) {
      if (axis.names.empty() && axis.edges.size() < 2) return false;
      if (axis.bins() > filled / bins) return false;
      bins *= axis.bins();
    }
    return bins == filled && tally.counts.size() == tally.count_squares.size() &&
           tally.sums.size() == tally.sum_squares.size();
  };
  return sums.counts.absorbed_in_medium.size() == header.media.size() &&
         sums.shifted_in_medium.size() == header.media.size() &&
         sums.counts.absorbed_at_surface.size() == header.surfaces.size() &&
         sums.shifted_at_surface.size() == header.surfaces.size() &&
         std::all_of(sums.counts.sensor_faces.begin(), sums.counts.sensor_faces.end(), has_names) &&
         std::all_of(sums.tallies.begin(), sums.tallies.end(), has_bins);
}

bool is_consistent(const RunOutline& run, const Shard& shard) {
  return !run.points.empty() && shard.number >= 1 && shard.number <= shard.of;
}

/// True when the media and reflectors of a point are among those of the run.
bool is_consistent(const tally::HistorySubjects& subjects,
                   const std::optional<results::HistoryColumns>& run) {
  const auto among = [](const auto& all, const auto& some) {
    return std::all_of(some.begin(), some.end(),
                       [&](const auto& one) { return std::find(all.begin(), all.end(), one) != all.end(); });
  };
  return run && among(run->media, subjects.media) && among(run->reflectors, subjects.reflectors) &&
         subjects.absorption_per_mm.size() == subjects.media.size() &&
         subjects.reflectance.size() == subjects.reflectors.size();
}

/// Rows of histories of a record, each a block's.
bool is_consistent(const tally::PhotonHistories& rows, const tally::HistorySubjects& subjects) {
  const std::size_t count = rows.rows(), media = subjects.media.size(),
                    reflectors = subjects.reflectors.size();
  return rows.event.size() == count && rows.photon.size() == count && rows.path_mm.size() == count * media &&
         rows.absorption_depth.size() == count * media && rows.reflections.size() == count * reflectors &&
         rows.reflection_depth.size() == count * reflectors;
}

}  // namespace

RangeReader::RangeReader(std::filesystem::path path) : path_(std::move(path)) {
  const std::uint64_t size = checked_size(path_);
  RecordStream records(path_, detail::kMagic.size() + sizeof(detail::kRangesVersion), size);
  if (records.next() != Record::outline) throw damaged(path_);
  records.decode(shard_, outline_);
  if (!is_consistent(outline_, shard_)) throw damaged(path_);
  std::uint64_t from = records.position();
  for (Record record = records.next(); record != Record::end; record = records.next()) {
    if (record == Record::surfaces) {
      records.decode(surfaces_);
      if (ranges_.empty()) from = records.position();
      continue;
    }
    if (record != Record::range) continue;
    std::uint64_t point = 0;
    tally::BlockRange blocks;
    Decoder decoder(records.content());
    try {
      detail::pass(decoder, point, blocks);
    } catch (const Undecodable&) {
      throw damaged(path_);
    }
    if (point >= outline_.points.size() || blocks.first >= blocks.last ||
        blocks.last > outline_.points[point].blocks)
      throw damaged(path_);
    ranges_.push_back({static_cast<std::size_t>(point), blocks, from, records.position()});
    from = records.position();
  }
  if (!records.at_end()) throw damaged(path_);
}

RangeReader::Content RangeReader::replay(const StoredRange& range, ResultSink& sink, bool begins) const {
  const tally::RunHeader& header = outline_.header;
  Content content;
  bool has_readout = false;
  std::size_t channels = 0, orders = 0, samples = 0;
  RecordStream records(path_, range.from, range.to);
  while (!records.at_end()) {
    switch (records.next()) {
      case Record::readout: {
        std::uint64_t point = 0;
        std::vector<tally::ReadoutChannel> list;
        std::optional<detector::ReadoutSpec> readout;
        records.decode(point, list, readout);
        has_readout = outline_.has_energy;
        channels = list.size();
        orders = readout ? readout->photon_order.size() : 0;
        samples = readout && readout->pulses && readout->period_ns > 0.0 ? readout->samples() : 0;
        if (begins) sink.begin_events(range.point, list, readout);
        break;
      }
      case Record::subjects:
        records.decode(content.histories.emplace());
        if (!is_consistent(*content.histories, outline_.histories)) throw damaged(path_);
        break;
      case Record::photons: {
        if (!outline_.photon_list) throw damaged(path_);
        const auto rows = records.rows<tally::DetectedPhoton>();
        for (const tally::DetectedPhoton& row : rows)
          if (!within(row.part, header.parts) || !within(row.face, header.faces) || row.point != range.point)
            throw damaged(path_);
        sink.photons(rows);
        break;
      }
      case Record::histories:
        for (const auto& rows : records.rows<tally::PhotonHistories>()) {
          if (!content.histories || !is_consistent(rows, *content.histories)) throw damaged(path_);
          sink.histories(rows, *content.histories);
        }
        break;
      case Record::events: {
        if (!has_readout) throw damaged(path_);
        const auto rows = records.rows<tally::EventRecord>();
        for (const tally::EventRecord& row : rows) {
          if (!within(row.part, header.parts) || row.channels.size() != channels || row.point != range.point)
            throw damaged(path_);
          for (const tally::ChannelRecord& channel : row.channels)
            if ((channel.order_ns.size() != orders && !channel.order_ns.empty()) ||
                (channel.waveform.size() != samples && !channel.waveform.empty()))
              throw damaged(path_);
        }
        sink.events(rows);
        break;
      }
      case Record::range: {
        RangeRecord record = read_range(records);
        if (!is_consistent(record.sums, header)) throw damaged(path_);
        content.sums = std::move(record.sums);
        content.facts = std::move(record.facts);
        break;
      }
      default:
        throw damaged(path_);
    }
  }
  sink.range({range.point, range.blocks, content.facts, content.histories ? &*content.histories : nullptr},
             content.sums);
  return content;
}

}  // namespace scintray::simulation
