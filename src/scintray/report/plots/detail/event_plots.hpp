#pragma once
/// Plots of what the events of a point say.

#include <string>
#include <vector>

#include "scintray/analysis/event_analysis.hpp"
#include "scintray/analysis/position/depth_curve.hpp"
#include "scintray/analysis/position/depth_of_interaction.hpp"
#include "scintray/analysis/position/flood_map.hpp"
#include "scintray/analysis/spectrum/spread.hpp"
#include "scintray/analysis/timing/coincidence_timing.hpp"
#include "scintray/analysis/timing/event_orders.hpp"
#include "scintray/report/plots/detail/grid_map.hpp"
#include "scintray/report/plots/svg_plot.hpp"

namespace scintray::report {

/// "photoelectrons" or "photons": what the light of a study counts.
std::string light_unit(const analysis::EventAnalysis& analysis);

/// The spectrum, with the fitted photopeak over it where there is one. The study has a spectrum.
Plot spectrum_plot(const analysis::EventAnalysis& analysis);

/// A depth curve relative to its reference, with its line dashed.
Plot depth_plot(const analysis::DepthCurve& curve);

/// Width (FWHM) and bias of the depth found, against depth.
Plot doi_plot(const analysis::DoiAnalysis& doi);

/// Counts of a flood map, four of its cells in one: the segmentation wants finer ones than the eye.
GridMap flood_picture(const analysis::FloodMap& flood);

/// A distribution of time differences with its Gaussian, in ps. The spread has fitted bins.
Plot difference_plot(const analysis::Spread& differences, const std::string& label);

/// CTR against depth, and the delay against depth, both in ps.
Plot timing_depth_plot(const analysis::TimingDepth& timing);

/// CTR by the n-th photon and by the mean of the first n, in ps, and the bound by the first n where it is
/// known. The study is not empty.
Plot order_plot(const analysis::OrderAnalysis& orders, const std::optional<analysis::TimingBound>& bound);

/// CTR against depth, in ps: by the first photon, by the n-th that is best in all, by the best mean of the
/// first n, and the bound by all photons where it is known.
Plot order_depth_plot(const analysis::EventAnalysis& analysis);

/// CTR by the n-th photon of several points, in ps.
Plot orders_plot(const std::vector<std::pair<std::string, analysis::OrderAnalysis>>& points);

}  // namespace scintray::report
