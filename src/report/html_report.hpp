#pragma once
/// A run as one self-contained HTML page: no scripts, nothing loaded from elsewhere.

#include <filesystem>
#include <string>

#include "scintray/tally/result.hpp"

namespace scintray {

/// The page: the answer first, then fates, sensors, angles, paths, conditions and the scene.
std::string html_report(const RunResult& run);

/// Writes the page under a temporary name and renames it, so that no half page is ever found.
/// Throws SystemError with path and reason.
void write_report(const std::filesystem::path& path, const RunResult& run);

}  // namespace scintray
