#include <fmt/format.h>

#include <algorithm>

#include "scintray/core/activity.hpp"
#include "scintray/core/text.hpp"
#include "scintray/simulation/range_file.hpp"

namespace scintray::simulation {

namespace {

/// A range and the file that holds it.
struct Piece {
  const RangeReader* reader = nullptr;
  StoredRange range;
};

/// Missing blocks of a point.
struct Gap {
  std::size_t point = 0;
  tally::BlockRange blocks;
};

/// Readers of all files. @throws InputError with every file that is damaged or of another run than the first
std::vector<RangeReader> open_all(const std::vector<std::filesystem::path>& files) {
  core::Problems problems;
  std::vector<RangeReader> readers;
  readers.reserve(files.size());
  for (const std::filesystem::path& file : files) {
    core::report_activity("reading parts: " + file.string(), readers.size(), files.size());
    try {
      readers.emplace_back(file);
    } catch (const core::InputError& error) {
      problems.add(error);
      continue;
    }
    const std::string other = difference(readers.back().outline(), readers.front().outline());
    if (!other.empty())
      problems.add({file.string()},
                   "this is of another run than " + readers.front().path().string() + ": " + other,
                   "merge the parts of one run only");
  }
  problems.throw_if_any();
  return readers;
}

/// All ranges in the order of points and blocks. @throws InputError when two hold the same blocks
std::vector<Piece> in_order(const std::vector<RangeReader>& readers) {
  std::vector<Piece> pieces;
  for (const RangeReader& reader : readers)
    for (const StoredRange& range : reader.ranges()) pieces.push_back({&reader, range});
  std::stable_sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) {
    return a.range.point != b.range.point ? a.range.point < b.range.point
                                          : a.range.blocks.first < b.range.blocks.first;
  });
  core::Problems problems;
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    const Piece &before = pieces[i - 1], &piece = pieces[i];
    if (before.range.point == piece.range.point && piece.range.blocks.first < before.range.blocks.last)
      problems.add({piece.reader->path().string()},
                   fmt::format("blocks {} to {} of point {} are also in {}", piece.range.blocks.first,
                               std::min(piece.range.blocks.last, before.range.blocks.last) - 1,
                               piece.range.point, before.reader->path().string()),
                   "leave one of the two files out");
  }
  problems.throw_if_any();
  return pieces;
}

std::vector<Gap> gaps_between(const std::vector<Piece>& pieces, const RunOutline& run) {
  std::vector<Gap> gaps;
  auto piece = pieces.begin();
  for (std::size_t point = 0; point < run.points.size(); ++point) {
    std::uint64_t next = 0;
    for (; piece != pieces.end() && piece->range.point == point; ++piece) {
      if (piece->range.blocks.first > next) gaps.push_back({point, {next, piece->range.blocks.first}});
      next = piece->range.blocks.last;
    }
    if (next < run.points[point].blocks) gaps.push_back({point, {next, run.points[point].blocks}});
  }
  return gaps;
}

/// "shards 3, 7 of 9", where all files are shards of one division and whole shards are missing; else the
/// blocks.
std::string missing_text(const std::vector<Gap>& gaps, const std::vector<RangeReader>& readers) {
  const RunOutline& run = readers.front().outline();
  std::vector<Shard> there;
  for (const RangeReader& reader : readers) there.push_back(reader.shard());
  const std::string shards = missing_shards(there, [&](const Shard& shard) {
    const tally::BlockRange of_run = blocks_of(shard, run);
    return std::any_of(gaps.begin(), gaps.end(), [&](const Gap& gap) {
      const tally::BlockRange blocks = blocks_of_point(of_run, run, gap.point);
      return blocks.first < gap.blocks.last && gap.blocks.first < blocks.last;
    });
  });
  if (!shards.empty()) return shards;
  std::vector<std::string> names;
  for (const Gap& gap : gaps)
    names.push_back(fmt::format("{} to {} of point {}", gap.blocks.first, gap.blocks.last - 1, gap.point));
  return "blocks " + list_of_first(std::move(names));
}

/// A point of which there is nothing.
tally::PointResult empty_point(const RunOutline& run, std::size_t point) {
  tally::PointSums none;
  none.counts.absorbed_in_medium.resize(run.header.media.size());
  none.counts.absorbed_at_surface.resize(run.header.surfaces.size());
  none.counts.events_in_medium.resize(run.header.media.size());
  none.counts.events_at_surface.resize(run.header.surfaces.size());
  none.shifted_in_medium.resize(run.header.media.size());
  none.shifted_at_surface.resize(run.header.surfaces.size());
  return finished_point(none, run, point, false);
}

/// Result of a point from its pieces, the rows of which go to the sink.
tally::PointResult merged_point(std::vector<Piece>::const_iterator first,
                                std::vector<Piece>::const_iterator last, ResultSink& sink, bool complete) {
  const RunOutline& run = first->reader->outline();
  RangeReader::Content total;
  for (auto piece = first; piece != last; ++piece) {
    RangeReader::Content content = piece->reader->replay(piece->range, sink, piece == first);
    if (piece == first) {
      total = std::move(content);
      continue;
    }
    if (!total.sums.alike(content.sums))
      throw core::InputError({{piece->reader->path().string()},
                              "the tallies of this file are not those of " + first->reader->path().string(),
                              "merge the parts of one run only"});
    total.sums.merge(content.sums);
  }
  tally::PointResult result = finished_point(total.sums, run, first->range.point, complete);
  static_cast<tally::PointFacts&>(result) = total.facts;
  sink.point(result, total.histories ? &*total.histories : nullptr);
  return result;
}

}  // namespace

tally::RunResult merge_ranges(const std::vector<std::filesystem::path>& files, ResultSink& sink,
                              bool partial) {
  if (files.empty()) throw core::InputError({{}, "there is no file to merge", "name the shards of a run"});
  const std::vector<RangeReader> readers = open_all(files);
  const RunOutline& run = readers.front().outline();
  const std::vector<Piece> pieces = in_order(readers);
  const std::vector<Gap> gaps = gaps_between(pieces, run);
  const std::string missing = gaps.empty() ? "" : missing_text(gaps, readers);
  if (!gaps.empty() && !partial)
    throw core::InputError({{},
                            "the run is not complete: " + missing + " missing",
                            "compute what is missing, or add --partial for what there is"});
  sink.begin(run);
  const auto has_surfaces = [](const RangeReader& reader) { return !reader.surfaces().empty(); };
  const auto surfaces = std::find_if(readers.begin(), readers.end(), has_surfaces);
  if (surfaces != readers.end()) sink.surfaces(surfaces->surfaces());

  tally::RunResult result;
  result.header = run.header;
  auto piece = pieces.begin();
  for (std::size_t point = 0; point < run.points.size() && piece != pieces.end(); ++point) {
    core::report_activity("merging points", point, run.points.size());
    const auto first = piece;
    while (piece != pieces.end() && piece->range.point == point) ++piece;
    const bool complete =
        std::none_of(gaps.begin(), gaps.end(), [&](const Gap& gap) { return gap.point == point; });
    if (first != piece) {
      result.points.push_back(merged_point(first, piece, sink, complete));
      continue;
    }
    result.points.push_back(empty_point(run, point));
    sink.point(result.points.back(), nullptr);
  }
  if (!gaps.empty()) result.partial_reason = "merged without " + missing;
  sink.commit(gaps.empty(), result.partial_reason);
  return result;
}

}  // namespace scintray::simulation
