#pragma once
/// What a scene was expected to show, beside what it showed.

#include <string>
#include <vector>

#include "scintray/report/run_analysis.hpp"
#include "scintray/scene_file/criterion.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::report {

struct Verdict {
  scene_file::ClaimSpec claim;
  std::string untold;  ///< why there is no number; empty when there is one
  core::Estimate ours;
  bool agrees = false;   ///< within the claim's bounds
  bool certain = false;  ///< and would still be, or still not be, two standard errors away
};

/// Light is per keV of energy deposited, times 511 keV, for runs of events; else the detected fraction.
/// @throws InputError as check_curves and surface_value do
std::vector<Verdict> judge(const tally::RunResult& run, const RunStudies& studies);

/// @throws InputError when there is no curve of the name that a claim, or the reference, has, naming those
///         there are, or there is no sweep over a number. Looks at the parameters of the points only, and
///         passes over claims about surfaces.
void check_curves(const tally::RunResult& run, const config::NameRef& reference,
                  const std::vector<scene_file::ClaimSpec>& claims);

/// A table; empty without claims.
std::string claim_section(const std::vector<Verdict>& verdicts);

/// The same for a terminal, one line a claim.
std::string claim_lines(const std::vector<Verdict>& verdicts);

}  // namespace scintray::report
