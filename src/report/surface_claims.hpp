#pragma once
/// Claims about surfaces on the bench.

#include <vector>

#include "scintray/analysis/surface_study.hpp"
#include "scintray/scene/claim_spec.hpp"

namespace scintray::report {

/// The number that a claim is about; angles in rad. The width of a lobe has no error.
/// @throws InputError when it was not read
Estimate surface_value(const ClaimSpec& claim, const std::vector<SurfaceStudy>& studies);

/// @throws InputError for claims about what no bench reads, naming what there is
void check_surface_claims(const std::vector<BenchSpec>& benches, const std::vector<ClaimSpec>& claims);

}  // namespace scintray::report
