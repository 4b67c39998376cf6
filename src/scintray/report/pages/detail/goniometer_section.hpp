#pragma once
/// The surfaces of a scene's benches on the page of its run.

#include <string>
#include <vector>

#include "scintray/analysis/goniometer/surface_analysis.hpp"

namespace scintray::report {

/// A section for each bench: mean slope met and reflectance against incidence, the latter beside Fresnel's
/// for each medium behind the surfaces, and where reflected light goes. Empty without studies. The page needs
/// hemisphere_map_style().
std::string bench_sections(const std::vector<analysis::SurfaceStudy>& studies);

}  // namespace scintray::report
