#pragma once
/// What a page or a summary shows of the events and the surfaces of a run, beside its fates.

#include <vector>

#include "scintray/analysis/event_study.hpp"
#include "scintray/analysis/surface_study.hpp"
#include "scintray/scene/claim_spec.hpp"

namespace scintray {

struct RunStudies {
  std::vector<EventStudy> points;  ///< in step with RunResult::points; empty for a run of photons
  NameRef reference;               ///< AnalysisSpec::reference
  std::vector<ClaimSpec> claims;
  std::vector<SurfaceStudy> surfaces;  ///< read on the bench
};

}  // namespace scintray
