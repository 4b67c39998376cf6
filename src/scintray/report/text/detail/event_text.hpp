#pragma once
/// Results of the analyses of events as text, for captions and terminals.

#include <optional>
#include <string>

#include "scintray/analysis/event_analysis.hpp"
#include "scintray/analysis/position/confusion.hpp"
#include "scintray/analysis/position/depth_curve.hpp"
#include "scintray/analysis/position/depth_of_interaction.hpp"
#include "scintray/analysis/position/flood_map.hpp"
#include "scintray/analysis/spectrum/spread.hpp"
#include "scintray/analysis/timing/coincidence_timing.hpp"
#include "scintray/analysis/timing/event_orders.hpp"

namespace scintray::report {

/// "photopeak 812.40 ± 0.52 photons, resolution ..., chi-square ..."; with the reason where it is not
/// trusted.
std::string peak_text(const analysis::EventAnalysis& analysis);
/// "falls by 0.512 ± 0.011 % per mm ..."
std::string depth_text(const analysis::DepthCurve& curve);
std::string doi_text(const analysis::DoiAnalysis& doi);
std::string flood_text(const analysis::FloodMap& flood);
/// "FWHM 212.3 ± 4.1 ps (Gaussian), ... ps (quantiles), mean ... ps, 2131 pairs"
std::string spread_text(const analysis::Spread& differences);
std::string timing_depth_text(const analysis::TimingDepth& timing);
/// The first photon, the best n, and the bound where it is known. Requires a non-empty analysis.
std::string order_text(const analysis::OrderAnalysis& orders,
                       const std::optional<analysis::TimingBound>& bound);
/// "n = 1: 212.3 ± 4.1 ps (bound 150), n = 5: ..."
std::string order_list(const analysis::OrderAnalysis& orders,
                       const std::optional<analysis::TimingBound>& bound);
/// "best photon at each depth: 2.1 mm: photon 3, 190.1 ± 6.0 ps ..."
std::string order_depth_text(const analysis::EventAnalysis& analysis);
/// "93.1 ± 0.2 % of the events assigned the right of 2 layers"
std::string layers_text(const analysis::Confusion& confusion);
/// In ps. NaN-free: "none" for a number that does not exist.
std::string picoseconds(const core::Estimate& time_ns);

}  // namespace scintray::report
