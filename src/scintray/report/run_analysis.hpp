#pragma once
/// What a page or a summary shows of the events and the surfaces of a run, beside its fates.

#include <vector>

#include "scintray/analysis/event_analysis.hpp"
#include "scintray/analysis/goniometer/surface_analysis.hpp"
#include "scintray/scene_file/criterion.hpp"

namespace scintray::report {

struct RunStudies {
  std::vector<analysis::EventStudy> points;  ///< in step with RunResult::points; empty for a run of photons
  config::NameRef reference;                 ///< AnalysisSpec::reference
  std::vector<scene_file::ClaimSpec> claims;
  std::vector<analysis::SurfaceStudy> surfaces;  ///< read on the bench
};

}  // namespace scintray::report
