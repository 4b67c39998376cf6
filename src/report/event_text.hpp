#pragma once
/// What studies of events found, in words, for captions and terminals.

#include <optional>
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
/// The first photon, the best n, and the bound where it is known. The study is not empty.
std::string order_text(const OrderStudy& orders, const std::optional<TimingBound>& bound);
/// "n = 1: 212.3 ± 4.1 ps (bound 150), n = 5: ..."
std::string order_list(const OrderStudy& orders, const std::optional<TimingBound>& bound);
/// "best photon at each depth: 2.1 mm: photon 3, 190.1 ± 6.0 ps ..."
std::string order_depth_text(const EventStudy& study);
/// "93.1 ± 0.2 % of the layers told rightly"
std::string layers_text(const Confusion& confusion);
/// In ps. NaN-free: "none" for a number that does not exist.
std::string picoseconds(const Estimate& time_ns);

}  // namespace scintray::report
