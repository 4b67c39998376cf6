#pragma once
/// Files of block ranges: parts of a run, as shards and checkpoints (docs/scaling.md).

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scintray/simulation/result_sink.hpp"

namespace scintray::simulation {

/// One of several parts of a run, of equal numbers of blocks.
struct Shard {
  std::uint64_t number = 1, of = 1;  ///< number counts from 1

  bool operator==(const Shard&) const = default;
};

/// Share of a shard in a number of blocks, which are divided equally.
tally::BlockRange part_of(const Shard& shard, std::uint64_t blocks);

/// "a, b, c", of 20 at most, and that there are more.
std::string list_of_first(std::vector<std::string> names);

/// "shard 3 of 9", "shards 3, 7 of 9": those for which `is_missing` holds, 20 at most by number. Empty where
/// the shards that are there are of several divisions, of none, or of more than a million.
std::string missing_shards(const std::vector<Shard>& there,
                           const std::function<bool(const Shard&)>& is_missing);
/// Blocks of a shard, counted over all points of a run; blocks of points follow each other.
tally::BlockRange blocks_of(const Shard& shard, const RunOutline& run);
/// Of these, the blocks of one point, counted within it. May be empty.
tally::BlockRange blocks_of_point(const tally::BlockRange& of_run, const RunOutline& run, std::size_t point);

/// What differs between two runs of which the results cannot be merged, as "the seed is 2, not 1"; empty when
/// they can.
std::string difference(const RunOutline& of, const RunOutline& from);

/// Sink that writes the block ranges of a run to a file: everything that the results file of the whole run
/// has of these blocks, bit for bit, and what the run depends on. There is no file at its path before
/// commit(); each record has a checksum, and a record ends the file, so that no part is taken for the whole.
class RangeFile : public ResultSink {
 public:
  /// @param shard  that the file is; 1 of 1 for blocks of a whole run
  explicit RangeFile(std::filesystem::path path, const Shard& shard = {});
  ~RangeFile() override;

  /// @throws SystemError for a path that cannot be written, as all members do
  void begin(const RunOutline& run) override;
  void surfaces(const std::vector<analysis::SurfaceAnalysis>& analyses) override;
  void paths(std::size_t point, const std::vector<tally::PhotonPath>& paths) override;
  void begin_events(std::size_t point, const std::vector<tally::ReadoutChannel>& channels,
                    const std::optional<detector::ReadoutSpec>& readout) override;
  void photons(const std::vector<tally::DetectedPhoton>& photons) override;
  void histories(const tally::PhotonHistories& histories, const tally::HistorySubjects& of_point) override;
  void events(const std::vector<tally::EventRecord>& events) override;
  void range(const PointRange& of, const tally::PointSums& sums) override;
  /// Puts the file in place when `complete`; otherwise nothing is left of it.
  void commit(bool complete, const std::string& reason) override;

 private:
  struct State;
  std::filesystem::path path_;
  Shard shard_;
  std::unique_ptr<State> state_;
};

/// Blocks of a point within a file.
struct StoredRange {
  std::size_t point = 0;
  tally::BlockRange blocks;
  std::uint64_t from = 0, to = 0;  ///< position of its records in the file, bytes
};

/// Reader of a file of block ranges, the whole of which has been compared with its checksums.
class RangeReader {
 public:
  /// @throws InputError for a file that is missing, is no such file, is unfinished or damaged, or of another
  ///         version of the layout
  explicit RangeReader(std::filesystem::path path);

  const std::filesystem::path& path() const { return path_; }
  const RunOutline& outline() const { return outline_; }
  const Shard& shard() const { return shard_; }
  /// In the order of the file, which is that of points and blocks.
  const std::vector<StoredRange>& ranges() const { return ranges_; }
  const std::vector<analysis::SurfaceAnalysis>& surfaces() const { return surfaces_; }

  /// Sums of a range and the rest of what is known of it.
  struct Content {
    tally::PointSums sums;
    tally::PointFacts facts;
    std::optional<tally::HistorySubjects> histories;
  };
  /// Passes a range to a sink, but for begin_events.
  /// @param begins  with begin_events, for the first range of a point
  Content replay(const StoredRange& range, ResultSink& sink, bool begins) const;

 private:
  std::filesystem::path path_;
  RunOutline outline_;
  Shard shard_;
  std::vector<StoredRange> ranges_;
  std::vector<analysis::SurfaceAnalysis> surfaces_;
};

/// Result of a point from its sums.
/// @param complete  the sums are over all of its blocks
tally::PointResult finished_point(const tally::PointSums& sums, const RunOutline& run, std::size_t point,
                                  bool complete);

/// Passes the ranges of files, whatever their order, to a sink as the run of all blocks in one process would
/// have done, bit for bit, and commits it. Wall times are sums.
///
/// @param files    of shards or checkpoints
/// @param partial  true to accept that blocks are missing: the result is then marked as partial, with the
///                 reason
/// @throws InputError for files that are damaged, of another run than the first, or that hold the same
///         blocks, with each of them; and for missing blocks unless `partial`, with what is missing
tally::RunResult merge_ranges(const std::vector<std::filesystem::path>& files, ResultSink& sink,
                              bool partial = false);

}  // namespace scintray::simulation
