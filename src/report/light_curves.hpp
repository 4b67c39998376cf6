#pragma once
/// Light output of events against a swept number, one curve for each setting of the other keys.

#include <string>
#include <vector>

#include "scintray/analysis/event_study.hpp"
#include "scintray/report/sweep_view.hpp"

namespace scintray::report {

/// What stands for the light output of a point.
struct LightOutput {
  Estimate light;          ///< photons, or photoelectrons behind a readout
  bool from_peak = false;  ///< the position of the photopeak; else the mean of the pulses
};

/// Light output of the points of a run: of each series by the photopeak when a fit locates it in all of its
/// points, else by the mean, so that no curve mixes the two. Points without pulses have a light of 0.
/// @param studies  of the points, in step with run.points
std::vector<LightOutput> light_outputs(const SweepView& view, const std::vector<EventStudy>& studies);

/// Plot and table; empty when no point has events.
std::string light_section(const SweepView& view, const std::vector<EventStudy>& studies);

/// The same table for a terminal: head, then a row for each value of the swept key.
std::vector<std::vector<std::string>> light_table(const SweepView& view,
                                                  const std::vector<EventStudy>& studies);

}  // namespace scintray::report
