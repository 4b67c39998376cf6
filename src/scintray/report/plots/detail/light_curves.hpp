#pragma once
/// Light output of events against a swept number, one curve for each setting of the other keys.

#include <string>
#include <vector>

#include "scintray/analysis/event_analysis.hpp"
#include "scintray/config/name_ref.hpp"
#include "scintray/report/text/sweep_view.hpp"

namespace scintray::report {

/// Light of an event of 511 keV: the light of all events over their energy, times that. It has no spread of
/// energies in it, so it is surer than the photopeak of the same events, and stands for the same.
core::Estimate light_of(const analysis::EventAnalysis& analysis);

/// Two plots with a table: that light, and the photopeak's position for the curves in which a fit locates it
/// at every point. Empty when no point has events.
/// @param studies    of the points of the run, in step with its points
/// @param reference  label of the curve whose first point counts as 1; empty: light in its own unit.
///                   @throws InputError when no curve has that label
std::string light_section(const SweepView& view, const std::vector<analysis::EventAnalysis>& analyses,
                          const config::NameRef& reference);

/// The table for a terminal: head, then a row for each value of the swept key. Empty without events.
std::vector<std::vector<std::string>> light_table(const SweepView& view,
                                                  const std::vector<analysis::EventAnalysis>& analyses,
                                                  const config::NameRef& reference);

/// Rows for columns when there are more columns than `most`.
std::vector<std::vector<std::string>> upright(const std::vector<std::vector<std::string>>& table,
                                              std::size_t most);

}  // namespace scintray::report
