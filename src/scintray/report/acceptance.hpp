#pragma once
/// Evaluation of the acceptance criteria of a scene.

#include <string>
#include <vector>

#include "scintray/report/run_analysis.hpp"
#include "scintray/scene_file/criterion.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::report {

struct Evaluation {
  scene_file::CriterionSpec criterion;
  std::string not_available;  ///< reason why there is no value; empty when there is one
  core::Estimate ours;
  bool agrees = false;   ///< within the criterion's bounds
  bool certain = false;  ///< the same evaluation two standard errors away
};

/// Evaluations of the criteria. Light is per keV of energy deposited, times 511 keV, for runs of events; else
/// the detected fraction.
/// @throws InputError as check_curves and surface_value
std::vector<Evaluation> evaluate(const tally::RunResult& run, const RunAnalysis& analyses);

/// Checks that the curves of the criteria, and of the reference, exist. Uses only the parameters of the
/// points, and skips criteria about surfaces.
/// @throws InputError when there is no curve with the name in a criterion or the reference, with the existing
///         names, or there is no sweep over a number
void check_curves(const tally::RunResult& run, const config::NameRef& reference,
                  const std::vector<scene_file::CriterionSpec>& criteria);

/// The evaluations as a table in HTML; empty without criteria.
std::string criterion_section(const std::vector<Evaluation>& evaluations);

/// The evaluations for a terminal, one line per criterion.
std::string criterion_lines(const std::vector<Evaluation>& evaluations);

}  // namespace scintray::report
