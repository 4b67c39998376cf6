#pragma once
/// Finished block ranges of a run in progress, kept so that it can be resumed.

#include <chrono>
#include <filesystem>
#include <memory>
#include <vector>

#include "scintray/simulation/range_file.hpp"

namespace scintray::simulation {

/// What is done with the checkpoints of an earlier run.
enum class Resume {
  refuse,   ///< those of this very run are an error, so that none is lost by mistake; others are removed
  resume,   ///< the run continues after them; those of another run are an error
  restart,  ///< they are removed
};

struct CheckpointSettings {
  std::filesystem::path folder;  ///< made when the first of them is written
  /// Between two, at least; longer where writing takes over 1 % of it. 0: after each block, whatever it
  /// takes.
  std::chrono::milliseconds every{60'000};
  Resume resume = Resume::refuse;
};

/// Checkpoints of a run in a folder of its own: files of block ranges, "000001.ranges" and so on, which
/// follow each other from the first block on. Each is put in place when it is whole, so that the folder holds
/// a run that can be resumed at any moment, however its process ends. Also a sink, of what is computed anew.
class Checkpoints : public ResultSink {
 public:
  explicit Checkpoints(CheckpointSettings settings) : settings_(std::move(settings)) {}
  ~Checkpoints() override;

  /// Reads what there is of earlier.
  /// @param shard  that is computed; 1 of 1 for all of the run
  /// @throws InputError as the settings have it
  void open(const RunOutline& run, const Shard& shard);
  /// First block of a point that is not among the earlier ones, counted within the point.
  std::uint64_t next_block(std::size_t point, std::uint64_t first) const;
  /// Blocks that are there of earlier, of all points.
  std::uint64_t earlier_blocks() const;
  /// Passes the earlier ranges of a point to a sink, but for begin_events.
  void replay(std::size_t point, ResultSink& sink) const;
  /// True when the next checkpoint is due.
  bool due() const;
  /// Puts the ranges since the last checkpoint in place, if there are any.
  void seal();
  /// Removes the folder, after a run that is complete.
  void remove();

  void surfaces(const std::vector<analysis::SurfaceAnalysis>& analyses) override;
  void paths(std::size_t point, const std::vector<tally::PhotonPath>& paths) override;
  void begin_events(std::size_t point, const std::vector<tally::ReadoutChannel>& channels,
                    const std::optional<detector::ReadoutSpec>& readout) override;
  void photons(const std::vector<tally::DetectedPhoton>& photons) override;
  void histories(const tally::PhotonHistories& histories, const tally::HistorySubjects& of_point) override;
  void events(const std::vector<tally::EventRecord>& events) override;
  void range(const PointRange& of, const tally::PointSums& sums) override;

 private:
  using Clock = std::chrono::steady_clock;
  struct Readout {
    std::size_t point = 0;
    std::vector<tally::ReadoutChannel> channels;
    std::optional<detector::ReadoutSpec> readout;
  };

  RangeFile& file();

  CheckpointSettings settings_;
  RunOutline run_;
  Shard shard_;
  std::vector<RangeReader> earlier_;
  std::optional<Readout> readout_;   ///< of the present point
  std::unique_ptr<RangeFile> file_;  ///< not yet in place
  std::size_t files_ = 0;            ///< in place
  bool has_range_ = false;           ///< file_ has a whole one
  Clock::time_point last_ = Clock::now();
  Clock::duration cost_{};  ///< of the last checkpoint
};

/// Files of a folder of checkpoints, in their order; the path itself when it is no folder.
std::vector<std::filesystem::path> range_files(const std::filesystem::path& path);

}  // namespace scintray::simulation
