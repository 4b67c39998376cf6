#pragma once
/// Analyses of the events of a run: spectra, light against depth, flood maps, depth of interaction, timing.

#include <string>
#include <vector>

#include "scintray/analysis/event_analysis.hpp"

namespace scintray::report {

/// The analysis of one point of a sweep.
struct PointAnalysis {
  std::string label;  ///< "rough, 2 mm"; "run" without a sweep
  analysis::EventAnalysis analysis;
};

/// A table of all points and the figures of each (those beyond the fourth collapsed), and the light against
/// depth over the points of a sweep, where their distance in depth exceeds the spread of their events.
/// Empty when no point has an event.
std::string event_section(const std::vector<PointAnalysis>& points);

/// One self-contained page with that section. @param under  the line below the title: the name of the file
std::string event_page(const std::string& title, const std::string& under,
                       const std::vector<PointAnalysis>& points);

/// The same numbers for a terminal; empty without events.
std::string event_lines(const analysis::EventAnalysis& analysis);

}  // namespace scintray::report
