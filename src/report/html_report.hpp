#pragma once
/// A run as one self-contained HTML page: no scripts, nothing loaded from elsewhere.

#include <filesystem>
#include <string>
#include <vector>

#include "scintray/analysis/event_study.hpp"
#include "scintray/tally/result.hpp"

namespace scintray {

/// The page: the answer first, then events, fates, sensors, angles, paths, conditions and the scene.
/// @param studies  of the events of the points, in step with run.points; empty when there are none
std::string html_report(const RunResult& run, const std::vector<EventStudy>& studies = {});

/// Writes the page under a temporary name and renames it, so that no half page is ever found.
/// Throws SystemError with path and reason.
void write_report(const std::filesystem::path& path, const RunResult& run,
                  const std::vector<EventStudy>& studies = {});

}  // namespace scintray
