#pragma once
/// The sections of the page of a run, as HTML, and their parts for a terminal.

#include <string>
#include <vector>

#include "scintray/analysis/goniometer/surface_analysis.hpp"
#include "scintray/report/text/sweep_view.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::report {

/// Detected fraction against the swept number: plot and table.
std::string sweep_section(const tally::RunResult& run, const SweepView& view);
/// Detected fraction of a single point, in large type.
std::string headline(const tally::PointResult& point);
/// Fates of all photons: bars and table.
std::string fate_section(const tally::RunResult& run);
/// Photons per sensor and face.
std::string sensor_section(const tally::RunResult& run);
/// Exit angle histograms, one plot per tally and point.
std::string angle_section(const tally::RunResult& run);
/// Path length of detected photons.
std::string path_section(const tally::RunResult& run);
/// Seed, version, speed, warnings.
std::string condition_section(const tally::RunResult& run);

/// One line for each medium and surface that shifted light; empty when none did.
std::string shift_lines(const tally::RunHeader& header, const tally::PointResult& point);
/// A table of wavelength shifting over all points; empty when none occurred.
std::string shift_section(const tally::RunResult& run);

/// A figure or a table for every tally of every point; empty without tallies.
std::string tally_section(const tally::RunResult& run);

/// One line per tally, for a terminal; empty without tallies.
std::string tally_lines(const tally::RunHeader& header, const tally::PointResult& point);

/// A section for each goniometer: mean visible slope and reflectance against incidence, the latter beside
/// Fresnel's for each medium behind the surfaces, and the directions of reflected light. Empty without
/// readings. The page needs hemisphere_map_style().
std::string goniometer_sections(const std::vector<analysis::SurfaceAnalysis>& analyses);

}  // namespace scintray::report
