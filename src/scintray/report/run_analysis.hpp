#pragma once
/// Analyses of the events and the surfaces of a run, for its page and its summary.

#include <vector>

#include "scintray/analysis/event_analysis.hpp"
#include "scintray/analysis/goniometer/surface_analysis.hpp"
#include "scintray/scene_file/criterion.hpp"

namespace scintray::report {

struct RunAnalysis {
  std::vector<analysis::EventAnalysis>
      points;                 ///< in step with RunResult::points; empty for a run of photons
  config::NameRef reference;  ///< AnalysisSpec::reference
  std::vector<scene_file::CriterionSpec> criteria;
  std::vector<analysis::SurfaceAnalysis> surfaces;  ///< goniometer readings
};

}  // namespace scintray::report
