#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "scintray/core/input_file.hpp"
#include "scintray/simulation/detail/range_stream.hpp"
#include "scintray/simulation/range_file.hpp"

namespace scintray::simulation {

namespace detail {

std::uint64_t checked_size(const std::filesystem::path& path, const FileHead& head) {
  const auto wrong = [&](std::string_view what, std::string_view hint) {
    return core::InputError({{path.string()}, std::string(what), std::string(hint)});
  };
  std::error_code error;
  if (!std::filesystem::exists(path, error))
    throw wrong("there is no such file", "check the name and the folder");
  if (!std::filesystem::is_regular_file(path, error)) throw wrong("this is not a file", head.no_file_hint);
  if (::access(path.c_str(), R_OK) != 0)
    throw core::SystemError(path.string() + ": cannot read: " + std::strerror(errno));
  const std::uint64_t size = std::filesystem::file_size(path, error);
  const std::string begin = core::read_beginning(path, head.size()).value_or("");
  if (begin.size() < head.size() || !begin.starts_with(head.magic)) throw wrong(head.other, head.other_hint);
  std::uint32_t layout = 0;
  Decoder(std::string_view(begin).substr(head.magic.size())).plain(layout);
  if (layout != head.version)
    throw wrong(std::string(head.name) + " has layout " + std::to_string(layout) +
                    ", and this program reads " + std::to_string(head.version),
                "use the version of ScintRay that wrote it");
  return size;
}

}  // namespace detail

using detail::Decoder;
using detail::Record;
using detail::RecordReader;
using detail::Undecodable;

namespace {

RecordReader opened(const std::filesystem::path& path, std::uint64_t from, std::uint64_t to) {
  return {path, std::make_unique<std::ifstream>(path, std::ios::binary), from, to};
}

constexpr detail::FileHead kHead{detail::kMagic,
                                 detail::kRangesVersion,
                                 "this file of block ranges",
                                 "name the file of a shard, or a folder of checkpoints",
                                 "this is not a shard or checkpoint of a run",
                                 "name files that `scintray run --shard` wrote"};

bool is_consistent(const RunOutline& run, const Shard& shard) {
  return !run.points.empty() && shard.number >= 1 && shard.number <= shard.of;
}

}  // namespace

RangeReader::RangeReader(std::filesystem::path path) : path_(std::move(path)) {
  const std::uint64_t size = detail::checked_size(path_, kHead);
  RecordReader records = opened(path_, kHead.size(), size);
  if (records.next() != Record::outline) throw records.damaged();
  records.decode(shard_, outline_);
  if (!is_consistent(outline_, shard_)) throw records.damaged();
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
      throw records.damaged();
    }
    if (point >= outline_.points.size() || blocks.first >= blocks.last ||
        blocks.last > outline_.points[point].blocks)
      throw records.damaged();
    ranges_.push_back({static_cast<std::size_t>(point), blocks, from, records.position()});
    from = records.position();
  }
  if (!records.at_end()) throw records.damaged();
}

RangeReader::Content RangeReader::replay(const StoredRange& range, ResultSink& sink, bool begins) const {
  RecordReader records = opened(path_, range.from, range.to);
  return detail::replay_range(records, outline_, range, {sink, begins});
}

}  // namespace scintray::simulation
