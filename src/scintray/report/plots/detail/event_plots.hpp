#pragma once
/// Plots of the analyses of a point's events.

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

/// Unit of the light of an analysis: "photoelectrons" or "photons".
std::string light_unit(const analysis::EventAnalysis& analysis);

/// The spectrum with the fitted photopeak, if any, and a scale in keV at the mean light per energy
/// deposited where that is known. Requires a spectrum.
Plot spectrum_plot(const analysis::EventAnalysis& analysis);

/// A depth curve relative to its reference, with its line dashed.
Plot depth_plot(const analysis::DepthCurve& curve);

/// Width (FWHM) and bias of the estimated depth, against depth.
Plot doi_plot(const analysis::DoiAnalysis& doi);

/// Spectrum of one part in a few lines' height, for a table. Empty when all its light is equal.
std::string small_spectrum(const analysis::PartLight& part);

/// Numbers of the parts of an analysis, from 1 in their order, as on its flood map: that of one part.
std::size_t part_number(const analysis::EventAnalysis& analysis, core::PartId part);

/// Counts of a flood map, four of its cells in one (the segmentation needs finer cells than a picture), with
/// the borders between the regions of its peaks and the number of the part that owns each. Colours are
/// logarithmic where the lowest peak has less than a fifth of the height of the highest. Requires a flood
/// map.
GridMap flood_picture(const analysis::EventAnalysis& analysis);

/// A distribution of time differences with its Gaussian, in ps. Requires fitted bins.
Plot difference_plot(const analysis::Spread& differences, const std::string& label);

/// CTR against depth, and the delay against depth, both in ps.
Plot timing_depth_plot(const analysis::TimingDepth& timing);

/// CTR by the n-th photon and by the mean of the first n, in ps, and the bound by the first n where it is
/// known. Requires a non-empty analysis.
Plot order_plot(const analysis::OrderAnalysis& orders, const std::optional<analysis::TimingBound>& bound);

/// CTR against depth, in ps: by the first photon, by the n-th that is best in all, by the best mean of the
/// first n, and the bound by all photons where it is known.
Plot order_depth_plot(const analysis::EventAnalysis& analysis);

/// CTR by the n-th photon of several points, in ps.
Plot orders_plot(const std::vector<std::pair<std::string, analysis::OrderAnalysis>>& points);

}  // namespace scintray::report
