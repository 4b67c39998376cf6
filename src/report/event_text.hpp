#pragma once
/// What studies of events found, in words, for captions and terminals.

#include <string>

#include "scintray/analysis/event_study.hpp"

namespace scintray::report {

/// "photopeak 812.40 ± 0.52 photons, resolution ..., chi-square ..."; why not, where it cannot be trusted.
std::string peak_text(const EventStudy& study);
/// "falls by 0.512 ± 0.011 % per mm ..."
std::string depth_text(const DepthCurve& curve);
std::string doi_text(const DoiStudy& doi);
std::string flood_text(const FloodMap& flood);
/// "FWHM 212.3 ± 4.1 ps (Gaussian), ... ps (quantiles), mean ... ps, 2131 pairs"
std::string spread_text(const Spread& differences);
std::string timing_depth_text(const TimingDepth& timing);
std::string order_text(const OrderStudy& orders);
/// "93.1 ± 0.2 % of the layers told rightly"
std::string layers_text(const Confusion& confusion);
/// In ps. NaN-free: "none" for a number that does not exist.
std::string picoseconds(const Estimate& time_ns);

}  // namespace scintray::report
