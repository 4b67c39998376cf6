#pragma once
/// Plots of goniometer readings.

#include <string>
#include <vector>

#include "scintray/analysis/goniometer/goniometer.hpp"
#include "scintray/analysis/goniometer/measured_profile.hpp"
#include "scintray/report/plots/svg_plot.hpp"

namespace scintray::report {

/// In-plane profile of the directions on one side as a histogram's outline, per sr.
PlotSeries profile_series(const std::string& label, const analysis::DirectionCounts& counts,
                          const analysis::GoniometerSettings& settings);
/// A measurement as points.
PlotSeries measured_series(const std::string& label, const analysis::MeasuredProfile& measured);
/// An empty plot for profiles from -90 to 90 deg.
Plot profile_plot(const std::string& title);

/// Reflectance against incidence.
PlotSeries reflectance_series(const std::string& label,
                              const std::vector<analysis::GoniometerReading>& readings);
/// Fresnel's reflectance for unpolarised light from index n1 to n2, up to 90 deg, dashed.
PlotSeries fresnel_series(const std::string& label, double n1, double n2);
/// An empty plot against incidence, 0 to 90 deg, of numbers from 0 to 1.
Plot incidence_plot(const std::string& title, const std::string& y_label);

}  // namespace scintray::report
