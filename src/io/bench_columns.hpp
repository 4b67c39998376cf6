#pragma once
/// Surfaces read on the bench, in a results file.

#include <vector>

#include "scintray/analysis/surface_study.hpp"
#include "scintray/core/h5.hpp"

namespace scintray::results_format {

/// Group /benches, described in docs/results.md; nothing without studies.
void put_surface_studies(h5::Group& root, const std::vector<SurfaceStudy>& studies);

/// Empty when the file has none. @throws SystemError for what is missing, std::invalid_argument for columns
/// that contradict each other
std::vector<SurfaceStudy> get_surface_studies(const h5::Group& root);

}  // namespace scintray::results_format
