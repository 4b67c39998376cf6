#pragma once
/// A run as one self-contained HTML page: nothing loaded from elsewhere.

#include <filesystem>
#include <string>
#include <vector>

#include "scintray/report/run_analysis.hpp"
#include "scintray/report/view/view_page.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::report {

/// The page: the answer first, then events, fates, sensors, angles, paths, the scene in three dimensions,
/// conditions and the scene file.
std::string html_report(const tally::RunResult& run, const RunAnalysis& analyses = {},
                        const RunView& view = {});

/// Writes the page under a temporary name and renames it, so that a partly written page is never found.
/// Throws SystemError with path and reason.
void write_report(const std::filesystem::path& path, const tally::RunResult& run,
                  const RunAnalysis& analyses = {}, const RunView& view = {});

}  // namespace scintray::report
