#pragma once
/// What a scene was expected to show, beside what it showed.

#include <string>
#include <vector>

#include "scintray/report/run_analysis.hpp"
#include "scintray/scene_file/criterion.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::report {

struct Evaluation {
  scene_file::CriterionSpec criterion;
  std::string not_available;  ///< why there is no number; empty when there is one
  core::Estimate ours;
  bool agrees = false;   ///< within the criterion's bounds
  bool certain = false;  ///< and would still be, or still not be, two standard errors away
};

/// Light is per keV of energy deposited, times 511 keV, for runs of events; else the detected fraction.
/// @throws InputError as check_curves and surface_value do
std::vector<Evaluation> evaluate(const tally::RunResult& run, const RunAnalysis& analyses);

/// @throws InputError when there is no curve of the name that a criterion, or the reference, has, naming
/// those
///         there are, or there is no sweep over a number. Looks at the parameters of the points only, and
///         passes over criteria about surfaces.
void check_curves(const tally::RunResult& run, const config::NameRef& reference,
                  const std::vector<scene_file::CriterionSpec>& criteria);

/// A table; empty without criteria.
std::string criterion_section(const std::vector<Evaluation>& evaluations);

/// The same for a terminal, one line a criterion.
std::string criterion_lines(const std::vector<Evaluation>& evaluations);

}  // namespace scintray::report
