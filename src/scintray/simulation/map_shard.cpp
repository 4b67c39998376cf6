#include "scintray/simulation/detail/map_shard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>

#include "scintray/core/activity.hpp"
#include "scintray/core/output_file.hpp"
#include "scintray/core/text.hpp"
#include "scintray/simulation/detail/range_stream.hpp"
#include "scintray/simulation/response.hpp"

namespace scintray::simulation {

namespace detail {

// Names of records and values are those of files of block ranges; only these types are of maps alone.

template <typename A>
void exchange(A& a, MapOrigin& v) {
  pass(a, v.version, v.scene_file, v.scene_text, v.inputs);
}
template <typename A>
void exchange(A& a, ResponseGrid& v) {
  pass(a, v.part, v.low, v.pitch, v.cells, v.photons);
}
template <typename A>
void exchange(A& a, ResponseMap& v) {
  pass(a, v.channels, v.seed, v.photons_per_cell, v.photons_per_channel, v.delays_kept, v.unpolarised,
       v.grids);
}
template <typename A>
void exchange(A& a, MapOutline& v) {
  pass(a, v.shard, v.origin, v.map, v.media);
}
template <typename A>
void exchange(A& a, CellResponse& v) {
  pass(a, v.photons, v.detected, v.delays_ns);
}
template <typename A>
void exchange(A& a, ChannelLight& v) {
  pass(a, v.sum, v.squares, v.photons, v.delays_ns);
}

}  // namespace detail

using detail::encoded;
using detail::Record;
using detail::RecordReader;

namespace {

/// First bytes of a shard, and the version of its layout after them.
constexpr std::string_view kShardMagic = "ScintRay response shard\n";
constexpr std::uint32_t kShardVersion = 1;
constexpr detail::FileHead kShardHead{
    kShardMagic,
    kShardVersion,
    "this shard of a response map",
    "name the file of a shard",
    "this is not a shard of a response map",
    "name files that `scintray response build --shard` wrote, and no others with them"};

/// A shard whose records have been compared with their checksums.
struct OpenShard {
  std::filesystem::path path;
  std::uint64_t size = 0;
  MapOutline outline;
  tally::BlockRange pieces;

  /// A reader that stands at the first record.
  RecordReader records() const {
    return {path, std::make_unique<std::ifstream>(path, std::ios::binary), kShardHead.size(), size};
  }
};

/// True for an outline from which a map can be made.
bool is_consistent(const MapOutline& outline) {
  const ResponseMap& map = outline.map;
  if (map.channels.empty() || map.grids.empty() || outline.media.size() != map.grids.size() ||
      map.backward() == (map.photons_per_cell > 0) || map.delays_kept == 0 || outline.shard.number < 1 ||
      outline.shard.number > outline.shard.of)
    return false;
  const std::uint32_t last = *std::max_element(outline.media.begin(), outline.media.end());
  if (last >= map.grids.size()) return false;
  for (std::uint32_t medium = 0; medium < last; ++medium)
    if (std::count(outline.media.begin(), outline.media.end(), medium) == 0) return false;
  for (const ResponseGrid& grid : map.grids)
    if (!grid.low.allFinite() || !grid.pitch.allFinite() || grid.pitch.minCoeff() <= 0.0 ||
        *std::min_element(grid.cells.begin(), grid.cells.end()) == 0)
      return false;
  try {
    refuse_too_large(map);
  } catch (const core::InputError&) {
    return false;
  }
  const auto has_photons = [&](const ResponseGrid& grid) {
    const auto valid = [&](std::uint32_t photons) {
      return photons == 0 || photons == map.photons_started();
    };
    return grid.photons.size() == (map.backward() ? grid.size() : 0) &&
           std::all_of(grid.photons.begin(), grid.photons.end(), valid);
  };
  return std::all_of(map.grids.begin(), map.grids.end(), has_photons);
}

/// Number of pieces of a map.
std::uint64_t pieces_of(MapOutline& outline) {
  return outline.map.backward() ? ChannelAssembly(outline.map, outline.media).pieces()
                                : CellAssembly(outline.map).pieces();
}

OpenShard opened(const std::filesystem::path& path) {
  OpenShard shard{path, detail::checked_size(path, kShardHead), {}, {}};
  RecordReader records = shard.records();
  if (records.next() != Record::outline) throw records.damaged();
  records.decode(shard.outline);
  if (!is_consistent(shard.outline)) throw records.damaged();
  shard.pieces = part_of(shard.outline.shard, pieces_of(shard.outline));
  std::uint64_t pieces = 0;
  for (; records.next() == Record::piece; ++pieces)
    if (pieces == shard.pieces.count()) throw records.damaged();
  if (pieces != shard.pieces.count() || !records.at_end()) throw records.damaged();
  return shard;
}

std::string light_of(const ResponseMap& map) {
  return map.backward() ? fmt::format("{} photons backward from each channel", map.photons_per_channel)
                        : fmt::format("{} photons from each cell", map.photons_per_cell);
}

std::string cells_of(const ResponseMap& map) {
  std::vector<std::string> cells;
  for (const ResponseGrid& grid : map.grids)
    cells.push_back(fmt::format("{} x {} x {}", grid.cells[0], grid.cells[1], grid.cells[2]));
  return core::list_of(cells);
}

/// Names of files of `from` that `of` does not have with the same content.
std::vector<std::string> names_missing(const std::vector<core::InputFile>& of,
                                       const std::vector<core::InputFile>& from) {
  std::vector<std::string> names;
  for (const core::InputFile& file : from)
    if (std::find(of.begin(), of.end(), file) == of.end()) names.push_back(file.name);
  return names;
}

/// What differs between two maps, as "the seed is 2, not 1"; empty when nothing does.
std::string map_difference(MapOutline of, MapOutline from) {
  const auto is_not = [](const std::string& what, const auto& one, const auto& other) {
    return fmt::format("{} {}, not {}", what, one, other);
  };
  if (of.origin.version != from.origin.version)
    return is_not("the version of ScintRay is", of.origin.version, from.origin.version);
  if (of.origin.scene_text != from.origin.scene_text) return "the scene file has another text";
  if (of.map.seed != from.map.seed) return is_not("the seed is", of.map.seed, from.map.seed);
  if (light_of(of.map) != light_of(from.map))
    return is_not("it is traced with", light_of(of.map), light_of(from.map));
  if (of.map.delays_kept != from.map.delays_kept)
    return is_not("times of flight kept are", of.map.delays_kept, from.map.delays_kept);
  if (cells_of(of.map) != cells_of(from.map))
    return is_not("the cells are", cells_of(of.map), cells_of(from.map));
  if (of.origin.inputs != from.origin.inputs) {
    std::vector<std::string> names = names_missing(of.origin.inputs, from.origin.inputs);
    if (names.empty()) names = names_missing(from.origin.inputs, of.origin.inputs);
    return "input files differ: " + core::list_quoted(names);
  }
  of.shard = from.shard = {};
  of.origin.scene_file = from.origin.scene_file = {};
  return encoded(of) == encoded(from) ? "" : "the channels or the places of the cells differ";
}

/// All shards in the order of their pieces. @throws InputError with every file that is damaged, of another
/// map than the first, or has the pieces of another
std::vector<OpenShard> open_shards(const std::vector<std::filesystem::path>& files) {
  core::Problems problems;
  std::vector<OpenShard> shards;
  for (const std::filesystem::path& file : files) {
    core::report_activity("reading shards: " + file.string(), shards.size(), files.size());
    try {
      OpenShard shard = opened(file);
      const std::string other = shards.empty() ? "" : map_difference(shard.outline, shards.front().outline);
      if (!other.empty())
        problems.add({file.string()},
                     "this is of another response map than " + shards.front().path.string() + ": " + other,
                     "merge the shards of one map only");
      else
        shards.push_back(std::move(shard));
    } catch (const core::InputError& error) {
      problems.add(error);
    }
  }
  problems.throw_if_any();
  std::stable_sort(shards.begin(), shards.end(),
                   [](const OpenShard& a, const OpenShard& b) { return a.pieces.first < b.pieces.first; });
  const OpenShard* before = nullptr;
  for (const OpenShard& shard : shards) {
    if (shard.pieces.count() == 0) continue;
    if (before && shard.pieces.first < before->pieces.last)
      problems.add({shard.path.string()},
                   "cells or channels of this shard are also in " + before->path.string(),
                   "leave one of the two files out");
    before = &shard;
  }
  problems.throw_if_any();
  return shards;
}

/// Ranges of pieces that no shard has.
std::vector<tally::BlockRange> gaps_of(const std::vector<OpenShard>& shards, std::uint64_t pieces) {
  std::vector<tally::BlockRange> gaps;
  std::uint64_t next = 0;
  for (const OpenShard& shard : shards) {
    if (shard.pieces.count() == 0) continue;
    if (shard.pieces.first > next) gaps.push_back({next, shard.pieces.first});
    next = shard.pieces.last;
  }
  if (next < pieces) gaps.push_back({next, pieces});
  return gaps;
}

/// "shards 3, 7 of 9", where all are of one division; else how much is missing.
std::string missing_of(const std::vector<OpenShard>& shards, const std::vector<tally::BlockRange>& gaps,
                       std::uint64_t pieces) {
  std::vector<Shard> there;
  for (const OpenShard& shard : shards) there.push_back(shard.outline.shard);
  const std::string names = missing_shards(there, [&](const Shard& shard) {
    const tally::BlockRange own = part_of(shard, pieces);
    return std::any_of(gaps.begin(), gaps.end(), [&](const tally::BlockRange& gap) {
      return own.first < gap.last && gap.first < own.last;
    });
  });
  if (!names.empty()) return names + (names.starts_with("shards") ? " are" : " is");
  std::uint64_t count = 0;
  for (const tally::BlockRange& gap : gaps) count += gap.count();
  return fmt::format("{} of {} pieces are", count, pieces);
}

/// Passes the pieces of a shard to the assembly of its map.
template <typename Piece, typename Assembly, typename Valid>
void add_pieces(const OpenShard& shard, Assembly& assembly, const Valid& is_valid) {
  RecordReader records = shard.records();
  records.next();
  for (std::uint64_t piece = shard.pieces.first; piece < shard.pieces.last; ++piece) {
    records.next();
    std::uint64_t number = 0;
    Piece content;
    records.decode(number, content);
    if (number != piece || !is_valid(piece, content)) throw records.damaged();
    assembly.add(piece, content);
  }
}

}  // namespace

struct MapShardWriter::State {
  explicit State(const std::filesystem::path& path)
      : file(path, core::Container::plain), records([this](std::string_view bytes) { file.write(bytes); }) {}

  core::OutputFile file;
  detail::RangeWriter records;
};

MapShardWriter::MapShardWriter(std::filesystem::path path, const Shard& shard, MapOrigin origin)
    : path_(std::move(path)), shard_(shard), origin_(std::move(origin)) {}

MapShardWriter::~MapShardWriter() = default;

void MapShardWriter::begin(const ResponseMap& map, const std::vector<std::uint32_t>& media) {
  state_ = std::make_unique<State>(path_);
  state_->file.write(kShardMagic);
  state_->file.write(encoded(kShardVersion));
  state_->records.write(Record::outline, encoded(MapOutline{shard_, origin_, map, media}));
}

void MapShardWriter::add(std::uint64_t piece, const CellResponse& response) {
  state_->records.write(Record::piece, encoded(piece, response));
}

void MapShardWriter::add(std::uint64_t piece, const ChannelLight& light) {
  state_->records.write(Record::piece, encoded(piece, light));
}

void MapShardWriter::commit() {
  state_->records.write(Record::end, {});
  state_->file.commit();
  state_.reset();
}

bool is_map_shard(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(path, error) &&
         core::read_beginning(path, kShardMagic.size()).value_or("") == kShardMagic;
}

ResponseFile merge_map_shards(const std::vector<std::filesystem::path>& files) {
  if (files.empty())
    throw core::InputError({{}, "there is no file to merge", "name the shards of a response map"});
  const std::vector<OpenShard> shards = open_shards(files);
  MapOutline outline = shards.front().outline;
  const std::uint64_t pieces = pieces_of(outline);
  const std::vector<tally::BlockRange> gaps = gaps_of(shards, pieces);
  if (!gaps.empty())
    throw core::InputError(
        {{},
         "the response map is not complete: " + missing_of(shards, gaps, pieces) + " missing",
         "compute what is missing; there are no partial response maps, as events in "
         "the missing cells would have no light"});
  ResponseMap& map = outline.map;
  if (map.backward()) {
    ChannelAssembly assembly(map, outline.media);
    for (const OpenShard& shard : shards)
      add_pieces<ChannelLight>(shard, assembly, [&](std::uint64_t piece, const ChannelLight& light) {
        return assembly.is_consistent(piece, light);
      });
  } else {
    CellAssembly assembly(map);
    for (const OpenShard& shard : shards)
      add_pieces<CellResponse>(shard, assembly, [&](std::uint64_t, const CellResponse& response) {
        return assembly.is_consistent(response);
      });
  }
  return {std::move(map), outline.origin.version, outline.origin.scene_file, outline.origin.scene_text};
}

}  // namespace scintray::simulation
