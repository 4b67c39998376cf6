#pragma once
/// The sections of the page, each as a piece of HTML.

#include <string>

#include "scintray/report/text/sweep_view.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::report {

/// Detected fraction against the swept number: plot and table.
std::string sweep_section(const tally::RunResult& run, const SweepView& view);
/// Detected fraction of a single point, in large type.
std::string headline(const tally::PointResult& point);
/// Where every photon ended: bars and table.
std::string fate_section(const tally::RunResult& run);
/// Photons per sensor and face.
std::string sensor_section(const tally::RunResult& run);
/// Exit angle histograms, one plot a tally and point.
std::string angle_section(const tally::RunResult& run);
/// Path length of detected photons.
std::string path_section(const tally::RunResult& run);
/// Seed, version, speed, warnings.
std::string condition_section(const tally::RunResult& run);

}  // namespace scintray::report
