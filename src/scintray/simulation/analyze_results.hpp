#pragma once
/// Analysis of the events of a results file.

#include <filesystem>
#include <string>
#include <vector>

#include "scintray/analysis/event_analysis.hpp"
#include "scintray/scene_file/analysis.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::simulation {

/// Analyses of the points of a run, in their order. Events are read in portions; 64 bytes of each are kept,
/// and 8 for each n-th photon whose time the readout recorded. Empty when the file has no events.
/// @param run   of the same file
/// @param spec  throws InputError for a part of a layer that the run does not have
std::vector<analysis::EventAnalysis> analyze_results(const std::filesystem::path& path,
                                                     const tally::RunResult& run,
                                                     const scene_file::AnalysisSpec& spec);

}  // namespace scintray::simulation
