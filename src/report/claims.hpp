#pragma once
/// What a scene was expected to show, beside what it showed.

#include <string>
#include <vector>

#include "scintray/analysis/event_study.hpp"
#include "scintray/scene/claim_spec.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::report {

struct Verdict {
  ClaimSpec claim;
  std::string untold;  ///< why there is no number; empty when there is one
  Estimate ours;
  bool agrees = false;   ///< within the claim's bounds
  bool certain = false;  ///< and would still be, or still not be, two standard errors away
};

/// Light is per keV of energy deposited, times 511 keV, for runs of events; else the detected fraction.
/// @param studies  of the events of the points, in step with run.points; empty for a run of photons
/// @throws InputError as check_curves does
std::vector<Verdict> judge(const RunResult& run, const std::vector<EventStudy>& studies,
                           const std::vector<ClaimSpec>& claims);

/// @throws InputError when there is no curve of the name that a claim, or the reference, has, naming those
///         there are, or there is no sweep over a number. Looks at the parameters of the points only.
void check_curves(const RunResult& run, const NameRef& reference, const std::vector<ClaimSpec>& claims);

/// A table; empty without claims.
std::string claim_section(const std::vector<Verdict>& verdicts);

/// The same for a terminal, one line a claim.
std::string claim_lines(const std::vector<Verdict>& verdicts);

}  // namespace scintray::report
