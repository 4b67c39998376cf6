#pragma once
/// Analysis of the events of a results file, and the same events with other electronics.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scintray/analysis/event_analysis.hpp"
#include "scintray/detector/readout_spec.hpp"
#include "scintray/scene_file/analysis.hpp"
#include "scintray/scene_file/tally_variable.hpp"
#include "scintray/simulation/simulation_options.hpp"
#include "scintray/tally/readout_channels.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::simulation {

/// Setup of the analyses of a point's events, less what only its results state: n-th photons and light
/// timing.
/// @param channels  of the point
/// @param parts     names of the run's parts; throws InputError for a part of a layer that is not among them
analysis::AnalysisSetup analysis_setup(const scene_file::AnalysisSpec& spec,
                                       const std::vector<tally::ReadoutChannel>& channels,
                                       const core::IdVector<core::PartId, std::string>& parts);

/// Analyses of the points of a run, in their order. Events are read in portions; 64 bytes of each are kept,
/// and 8 for each n-th photon whose time the readout recorded. Empty when the file has no events.
/// @param run   of the same file
/// @param spec  throws InputError for a part of a layer that the run does not have
std::vector<analysis::EventAnalysis> analyze_results(const std::filesystem::path& path,
                                                     const tally::RunResult& run,
                                                     const scene_file::AnalysisSpec& spec);

/// Analysis of the events of a run as they come, point after point, by the [analysis] of its scene.
class RunningAnalysis {
 public:
  explicit RunningAnalysis(const tally::RunHeader& header);
  /// @param channels  of the point, with the ids of the header
  /// @throws InputError for a part of a layer that the run does not have
  void begin_point(const std::vector<tally::ReadoutChannel>& channels,
                   const std::optional<detector::ReadoutSpec>& readout);
  void add(const std::vector<tally::EventRecord>& events);
  /// The analysis of the point; nothing when it has no events.
  std::optional<analysis::EventAnalysis> finish_point(const tally::PointResult& result);

 private:
  core::IdVector<core::PartId, std::string> parts_;
  scene_file::AnalysisSpec spec_;
  std::optional<analysis::EventCollector> collector_;
};

/// Writes a result like the one at `path`, whose events have the charges, times and waveforms of other
/// electronics for the same detected photons. The list of photons is not copied. With the electronics of the
/// run the numbers are its own, except for the rounding of recorded times and positions to single precision:
/// random streams are those of the run. Sensors are those of the scene.
/// @param run        of the same file; its scene is built again, so files that it names must still exist
/// @param readout    checked by the reader of [readout]
/// @param options    of the simulation that builds the scene, with the models that it may name; the seed is
///                   that of the run
/// @param extensions  that the scene was read with
/// @throws InputError without events or without a list of their photons, for a scene whose sensors are not
///         those of the result, and for electronics that do not suit a sensor
void rerun_readout(const std::filesystem::path& path, const tally::RunResult& run,
                   const detector::ReadoutSpec& readout, const std::filesystem::path& output,
                   SimulationOptions options = {}, const scene_file::Extensions& extensions = {});

}  // namespace scintray::simulation
