#pragma once
/// The results file: HDF5, described field by field in docs/results.md; its rows for other programs.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scintray/analysis/event_analysis.hpp"
#include "scintray/analysis/goniometer/surface_analysis.hpp"
#include "scintray/detector/readout_spec.hpp"
#include "scintray/results/history_table.hpp"
#include "scintray/results/photon_list_layout.hpp"
#include "scintray/tally/event_record.hpp"
#include "scintray/tally/photon_path.hpp"
#include "scintray/tally/readout_channels.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::results {

/// Version of the layout; it increases when a reader of the older one would misread the newer.
inline constexpr std::int64_t kResultsVersion = 2;

/// Writer of one results file during a run. There is no file at `path` before commit().
class ResultsWriter {
 public:
  /// Creates the file at once, so that a path that cannot be written is an error before hours of work.
  /// `photon_list` also prepares the list of detected photons. Throws InputError when `path` is
  /// a file that is not a ScintRay result, SystemError when it cannot be written.
  ResultsWriter(const std::filesystem::path& path, const tally::RunHeader& header, bool photon_list);
  ResultsWriter(ResultsWriter&&) noexcept;
  ResultsWriter& operator=(ResultsWriter&&) noexcept;
  /// Without commit() the file is removed.
  ~ResultsWriter();

  /// Adds the goniometer readings; once at most.
  void add_surfaces(const std::vector<analysis::SurfaceAnalysis>& analyses);
  /// Appends to the list of detected photons. Rows are written in blocks, so memory is bounded.
  void append_photons(const std::vector<tally::DetectedPhoton>& photons);
  /// Prepares a list of detected photons, in place of the constructor.
  void begin_photons(const PhotonListLayout& layout);
  /// Prepares the tables of photon paths, before the first of them; without it the file has none.
  void begin_paths();
  /// Appends the paths of a point, as append_photons does.
  void append_paths(std::size_t point, const std::vector<tally::PhotonPath>& paths);
  /// Sets the readout of the events of a point, before the first of them; without it the file has
  /// no events. Throws InputError when points differ in the length of waveforms or in the order of photons.
  void begin_events(std::size_t point, std::vector<tally::ReadoutChannel> channels,
                    const std::optional<detector::ReadoutSpec>& readout);
  /// Appends to the table of events, as append_photons does.
  void append_events(const std::vector<tally::EventRecord>& events);
  /// Prepares the table of photon histories, before the first of them; without it the file has none.
  void begin_histories(HistoryColumns columns);
  /// Appends histories of the point that has these media and reflectors, as append_photons does.
  void append_histories(const tally::PhotonHistories& histories, const tally::HistorySubjects& point);
  /// Adds the result of the next point, its optics as traced where histories are kept, and the analysis of
  /// its events where there is one.
  void add_point(const tally::PointResult& point, const tally::HistorySubjects* history = nullptr,
                 const analysis::EventAnalysis* analysis = nullptr);
  /// Replaces the warnings of the header, which may grow during the run.
  void set_note(const std::string& note);
  /// Renames the file to its path. An interrupted run is committed with complete = false and the reason
  /// ("interrupted by Ctrl-C"); readers then show it as partial.
  void commit(bool complete, const std::string& reason_if_partial = {});

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Completeness of a file.
struct ResultsStatus {
  bool complete = false;
  std::string reason;  ///< empty when complete
  bool has_photon_list = false;
  std::uint64_t listed_photons = 0;
  std::uint64_t listed_events = 0;  ///< 0 when there are none
};

/// Content of a file without the photon list. Throws InputError when the file is missing, is not a ScintRay
/// result, has a version this program does not read (both versions are named) or is inconsistent.
tally::RunResult read_results(const std::filesystem::path& path);
/// Completeness of a file. Throws InputError as read_results.
ResultsStatus read_results_status(const std::filesystem::path& path);

/// Selection of photons and columns in the photon list. @throws InputError when there is no list
PhotonListLayout read_photon_layout(const std::filesystem::path& path);
/// At most `count` detected photons from row `offset` on; members without a column in the file are NaN, no
/// id, or 0. Throws InputError when there is no list.
std::vector<tally::DetectedPhoton> read_photons(const std::filesystem::path& path, std::uint64_t offset,
                                                std::uint64_t count);

/// Recorded paths of a point's photons; empty when there are none.
std::vector<tally::PhotonPath> read_paths(const std::filesystem::path& path, std::size_t point);

/// Goniometer readings; empty when there are none. Throws InputError as read_results.
std::vector<analysis::SurfaceAnalysis> read_surfaces(const std::filesystem::path& path);

/// Readout of the events of a point; empty when it has no events.
std::vector<tally::ReadoutChannel> read_channels(const std::filesystem::path& path, std::size_t point);

/// Numbers n, from 1, of the recorded times of n-th photons; empty without such times.
std::vector<std::uint64_t> read_photon_order(const std::filesystem::path& path);

/// Parts of events that are read.
enum class EventDetail {
  numbers,       ///< without the times of n-th photons and the waveforms
  photon_times,  ///< without the waveforms
  all,
};

/// At most `count` events from row `offset` on, in the order of points. Each has all channels of its
/// point. Throws InputError when there are no events.
std::vector<tally::EventRecord> read_events(const std::filesystem::path& path, std::uint64_t offset,
                                            std::uint64_t count, EventDetail detail = EventDetail::all);

/// True when `path` is an HDF5 file that ScintRay wrote as a result, of any version.
bool is_results_file(const std::filesystem::path& path);

/// Writes a table of a results file (photons, events, signals, paths, path_steps) as columns of 64-bit
/// floating-point numbers, with the names of the results file.
///
/// The extension of the output selects the format: .csv, with a heading; .npy, a structured array of NumPy
/// with a field per column; .lh5, HDF5 with the attributes of LEGEND's data format (datatype "table{...}" of
/// the group, "array<1>{real}" and units of the columns; legend-data-format-specs, "HDF5 File Format").
/// @param table  group of the results file
/// @return number of rows
/// @throws InputError for a file that is not a result, a table that it does not have, and other extensions
std::uint64_t export_rows(const std::filesystem::path& results, const std::string& table,
                          const std::filesystem::path& output);

}  // namespace scintray::results
