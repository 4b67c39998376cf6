#pragma once
/// Surfaces read on the goniometer, in a results file.

#include <vector>

#include "scintray/analysis/goniometer/surface_analysis.hpp"
#include "scintray/core/h5.hpp"

namespace scintray::results::format {

/// Group /benches, described in docs/results.md; nothing without studies.
void put_surface_analyses(core::h5::Group& root, const std::vector<analysis::SurfaceAnalysis>& analyses);

/// Empty when the file has none. @throws SystemError for what is missing, std::invalid_argument for columns
/// that contradict each other
std::vector<analysis::SurfaceAnalysis> get_surface_analyses(const core::h5::Group& root);

}  // namespace scintray::results::format
