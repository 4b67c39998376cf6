#include <algorithm>

#include "scintray/core/zlib_stream.hpp"
#include "scintray/simulation/detail/photon_rows.hpp"
#include "scintray/simulation/detail/range_stream.hpp"

namespace scintray::simulation::detail {

RecordReader::RecordReader(std::filesystem::path name, std::unique_ptr<std::istream> stream,
                           std::uint64_t from, std::uint64_t to)
    : name_(std::move(name)), stream_(std::move(stream)), at_(from), end_(to) {
  if (!stream_->seekg(static_cast<std::streamoff>(from))) throw damaged();
}

core::InputError RecordReader::damaged() const {
  return core::InputError({{name_.string()},
                           "this shard or checkpoint is damaged or was not written to its end",
                           "copy it again from where it was made, or compute it again"});
}

Record RecordReader::next() {
  std::string head = read(kRecordHead);
  std::uint8_t kind = 0;
  std::uint64_t length = 0;
  Decoder decoder(head);
  pass(decoder, kind, length);
  if (length > end_ - at_) throw damaged();
  content_ = read(length);
  std::uint32_t sum = 0;
  const std::string tail = read(kRecordTail);
  Decoder(tail).plain(sum);
  if (sum != core::crc32(content_, core::crc32(head))) throw damaged();
  return static_cast<Record>(kind);
}

std::string RecordReader::read(std::uint64_t bytes) {
  if (bytes > end_ - at_) throw damaged();
  std::string text(bytes, '\0');
  if (!stream_->read(text.data(), static_cast<std::streamsize>(bytes))) throw damaged();
  at_ += bytes;
  return text;
}

namespace {

/// Sums over blocks.
struct RangeRecord {
  std::uint64_t point = 0;
  tally::BlockRange blocks;
  tally::PointFacts facts;
  tally::PointSums sums;
};

RangeRecord read_range(const RecordReader& records) {
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
    const auto none_or_all = [](const auto& events, const auto& photons) {
      return events.empty() || events.size() == photons.size();
    };
    return bins == filled && tally.counts.size() == tally.count_squares.size() &&
           tally.sums.size() == tally.sum_squares.size() &&
           none_or_all(tally.event_count_squares, tally.counts) &&
           tally.event_count_products.size() == tally.event_count_squares.size() &&
           none_or_all(tally.event_squares, tally.sums) &&
           tally.event_products.size() == tally.event_squares.size() &&
           (tally.group_counts.empty() ||
            tally.group_counts.size() == tally::kEventGroups * tally.counts.size());
  };
  return sums.counts.absorbed_in_medium.size() == header.media.size() &&
         sums.shifted_in_medium.size() == header.media.size() &&
         sums.counts.absorbed_at_surface.size() == header.surfaces.size() &&
         sums.counts.events_in_medium.size() == header.media.size() &&
         sums.counts.events_at_surface.size() == header.surfaces.size() &&
         sums.shifted_at_surface.size() == header.surfaces.size() &&
         std::all_of(sums.counts.sensor_faces.begin(), sums.counts.sensor_faces.end(), has_names) &&
         std::all_of(sums.tallies.begin(), sums.tallies.end(), has_bins);
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

/// The paths of a record.
std::vector<tally::PhotonPath> read_paths(const RecordReader& records, const RunOutline& run,
                                          const StoredRange& of) {
  std::uint64_t point = 0;
  std::vector<tally::PhotonPath> paths;
  records.decode(point, paths);
  const auto is_path = [](const tally::PhotonPath& path) {
    return core::is_final(path.fate) && static_cast<int>(path.fate) < core::kStepEventCount &&
           path.steps.size() >= 2;
  };
  if (!run.paths || point != of.point || of.blocks.first != 0 ||
      !std::all_of(paths.begin(), paths.end(), is_path))
    throw records.damaged();
  return paths;
}

}  // namespace

RangeReader::Content replay_range(RecordReader& records, const RunOutline& run, const StoredRange& of,
                                  const RangeTarget& target) {
  const tally::RunHeader& header = run.header;
  ResultSink& sink = target.sink;
  RangeReader::Content content;
  const PhotonRows photon_rows(run.photons);
  tally::DetectedPhoton absent = results::format::unknown_photon();
  absent.point = static_cast<std::uint32_t>(of.point);
  bool has_readout = false;
  std::size_t channels = 0, orders = 0, samples = 0;
  while (!records.at_end()) {
    switch (records.next()) {
      case Record::paths:
        sink.paths(of.point, read_paths(records, run, of));
        break;
      case Record::readout: {
        std::uint64_t point = 0;
        std::vector<tally::ReadoutChannel> list;
        std::optional<detector::ReadoutSpec> readout;
        records.decode(point, list, readout);
        has_readout = run.has_energy;
        channels = list.size();
        orders = readout ? readout->photon_order.size() : 0;
        samples = readout && readout->pulses && readout->period_ns > 0.0 ? readout->samples() : 0;
        if (target.begins) sink.begin_events(of.point, list, readout);
        break;
      }
      case Record::subjects:
        records.decode(content.histories.emplace());
        if (!is_consistent(*content.histories, run.histories)) throw records.damaged();
        break;
      case Record::photons: {
        if (!run.photon_list || photon_rows.are_empty()) throw records.damaged();
        const auto rows = records.rows(absent, [&](Decoder& decoder, tally::DetectedPhoton& photon) {
          photon_rows.exchange(decoder, photon);
        });
        for (const tally::DetectedPhoton& row : rows)
          if (!within(row.part, header.parts) || !within(row.face, header.faces)) throw records.damaged();
        sink.photons(rows);
        break;
      }
      case Record::histories:
        for (const auto& rows : records.rows<tally::PhotonHistories>()) {
          if (!content.histories || !is_consistent(rows, *content.histories)) throw records.damaged();
          sink.histories(rows, *content.histories);
        }
        break;
      case Record::events: {
        if (!has_readout) throw records.damaged();
        const auto rows = records.rows<tally::EventRecord>();
        for (const tally::EventRecord& row : rows) {
          if (!within(row.part, header.parts) || row.channels.size() != channels || row.point != of.point)
            throw records.damaged();
          for (const tally::ChannelRecord& channel : row.channels)
            if ((channel.order_ns.size() != orders && !channel.order_ns.empty()) ||
                (channel.waveform.size() != samples && !channel.waveform.empty()))
              throw records.damaged();
        }
        sink.events(rows);
        break;
      }
      case Record::range: {
        RangeRecord record = read_range(records);
        if (record.point != of.point || record.blocks != of.blocks || !is_consistent(record.sums, header))
          throw records.damaged();
        content.sums = std::move(record.sums);
        if (target.wall_seconds) content.sums.counts.wall_seconds = *target.wall_seconds;
        content.facts = std::move(record.facts);
        break;
      }
      default:
        throw records.damaged();
    }
  }
  sink.range({of.point, of.blocks, content.facts, content.histories ? &*content.histories : nullptr},
             content.sums);
  return content;
}

}  // namespace scintray::simulation::detail
