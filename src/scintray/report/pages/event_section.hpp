#pragma once
/// Analyses of the events of a run: spectra, light against depth, flood maps, depth of interaction, timing.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scintray/analysis/event_analysis.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::report {

/// The analysis of one point of a sweep.
struct PointAnalysis {
  std::string label;  ///< "rough, 2 mm"; "run" without a sweep
  analysis::EventAnalysis analysis;
  std::optional<std::vector<tally::OmittedEffect>> omitted;  ///< PointResult::omitted
  /// Crystals in the plane of the flood map: least x and y, largest x and y, mm. Empty when not available.
  std::vector<std::array<double, 4>> crystals{};
};

/// Names of the parts of a run, by their ids.
using PartNames = core::IdVector<core::PartId, std::string>;

/// A table of all points and the figures of each (those beyond the fourth collapsed), light and spectrum of
/// each part, and the light against depth over the points of a sweep, where their distance in depth exceeds
/// the spread of their events. Empty when no point has an event.
std::string event_section(const std::vector<PointAnalysis>& points, const PartNames& parts);

/// One self-contained page with that section. @param under  the line below the title: the name of the file
std::string event_page(const std::string& title, const std::string& under,
                       const std::vector<PointAnalysis>& points, const PartNames& parts);

/// The same numbers for a terminal, each resolution and CTR with the effects that it does not include; empty
/// without events.
std::string event_lines(const analysis::EventAnalysis& analysis,
                        const std::optional<std::vector<tally::OmittedEffect>>& omitted);

}  // namespace scintray::report
