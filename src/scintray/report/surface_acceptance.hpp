#pragma once
/// Acceptance criteria about surfaces on a goniometer.

#include <vector>

#include "scintray/analysis/goniometer/surface_analysis.hpp"
#include "scintray/scene_file/criterion.hpp"

namespace scintray::report {

/// The value of a criterion's quantity; angles in rad. The width of a lobe has no error.
/// @throws InputError when there is no such reading
core::Estimate surface_value(const scene_file::CriterionSpec& criterion,
                             const std::vector<analysis::SurfaceAnalysis>& analyses);

/// Checks the criteria about surfaces. @throws InputError for one without a goniometer reading, with the
/// readings available
void check_surface_criteria(const std::vector<scene_file::GoniometerSpec>& goniometers,
                            const std::vector<scene_file::CriterionSpec>& criteria);

}  // namespace scintray::report
