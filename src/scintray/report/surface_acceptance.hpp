#pragma once
/// Claims about surfaces on the bench.

#include <vector>

#include "scintray/analysis/goniometer/surface_analysis.hpp"
#include "scintray/scene_file/criterion.hpp"

namespace scintray::report {

/// The number that a claim is about; angles in rad. The width of a lobe has no error.
/// @throws InputError when it was not read
core::Estimate surface_value(const scene_file::CriterionSpec& criterion,
                             const std::vector<analysis::SurfaceAnalysis>& analyses);

/// @throws InputError for claims about what no bench reads, naming what there is
void check_surface_criteria(const std::vector<scene_file::GoniometerSpec>& goniometers,
                            const std::vector<scene_file::CriterionSpec>& criteria);

}  // namespace scintray::report
