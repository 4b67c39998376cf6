#pragma once
/// Goniometer readings in a results file.

#include <vector>

#include "scintray/analysis/goniometer/surface_analysis.hpp"
#include "scintray/core/h5.hpp"

namespace scintray::results::format {

/// Writes the group /benches, described in docs/results.md; none without readings.
void put_surface_analyses(core::h5::Group& root, const std::vector<analysis::SurfaceAnalysis>& analyses);

/// Readings of a file; empty when it has none. @throws SystemError for missing datasets,
/// std::invalid_argument for columns that contradict each other
std::vector<analysis::SurfaceAnalysis> get_surface_analyses(const core::h5::Group& root);

}  // namespace scintray::results::format
