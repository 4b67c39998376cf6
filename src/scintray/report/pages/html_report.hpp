#pragma once
/// A run as one self-contained HTML page: nothing loaded from elsewhere.

#include <filesystem>
#include <string>
#include <vector>

#include "scintray/report/run_analysis.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::report {

/// The page: the answer first, then events, fates, sensors, angles, paths, conditions and the scene.
std::string html_report(const tally::RunResult& run, const RunAnalysis& analyses = {});

/// Writes the page under a temporary name and renames it, so that a partly written page is never found.
/// Throws SystemError with path and reason.
void write_report(const std::filesystem::path& path, const tally::RunResult& run,
                  const RunAnalysis& analyses = {});

}  // namespace scintray::report
