#include "scintray/report/text/detail/event_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scintray/report/plots/detail/event_plots.hpp"
#include "scintray/report/text/format.hpp"

namespace scintray::report {

namespace {

std::string goodness_text(const core::ChiSquare& goodness) {
  return fmt::format("chi-square {:.1f} for {:.0f} degrees of freedom (p {:.2g})", goodness.chi2,
                     goodness.degrees, goodness.p_value);
}

std::string background_text(analysis::PeakBackground background) {
  switch (background) {
    case analysis::PeakBackground::none:
      return "Gaussian";
    case analysis::PeakBackground::shoulder:
      return "Gaussian on a shoulder";
    case analysis::PeakBackground::shoulder_and_constant:
      return "Gaussian on a shoulder and a constant";
  }
  return "";
}

}  // namespace

std::string picoseconds(const core::Estimate& time_ns) {
  if (!std::isfinite(time_ns.value) || !std::isfinite(time_ns.error)) return "none";
  return with_error({1e3 * time_ns.value, 1e3 * time_ns.error}) + " ps";
}

std::string peak_text(const analysis::EventAnalysis& analysis) {
  const analysis::Photopeak& peak = analysis.peak;
  std::string text;
  if (peak.has_numbers())
    text = "photopeak " + with_error(peak.fit.position) + " " + light_unit(analysis) +
           ", energy resolution " + percent_with_error(peak.fit.relative_fwhm) + " FWHM; " +
           background_text(peak.fit.background) + ", " + goodness_text(peak.fit.goodness);
  if (peak.status == analysis::PeakStatus::trusted) return text;
  const std::string why =
      std::string("not to be trusted: ") + analysis::status_name(peak.status) + " (" + peak.reason + ")";
  return text.empty() ? "no photopeak: " + peak.reason : text + "; " + why;
}

std::string depth_text(const analysis::DepthCurve& curve) {
  const double least =
      std::min_element(curve.relative.begin(), curve.relative.end(), [](const auto& a, const auto& b) {
        return a.value < b.value;
      })->value;
  const double most =
      std::max_element(curve.relative.begin(), curve.relative.end(), [](const auto& a, const auto& b) {
        return a.value < b.value;
      })->value;
  std::string text =
      fmt::format("{} at {} depths, relative to that at {} mm: {} to {}",
                  curve.points.front().from_peak ? "photopeak" : "mean light", curve.points.size(),
                  compact(curve.points[curve.reference].depth_mm, 3), compact(least, 4), compact(most, 4));
  if (curve.points.size() < 2) return text;
  text += "; slope " + percent_with_error(curve.relative_slope_per_mm) + " per mm";
  if (curve.points.size() > 2) text += "; line: " + goodness_text(curve.line.goodness);
  return text;
}

std::string doi_text(const analysis::DoiAnalysis& doi) {
  const analysis::Spread& residual = doi.residual;
  std::string text = doi.ratio == analysis::EndRatio::share ? "from A / (A + B)" : "from ln(A / B)";
  text += doi.kind == analysis::DoiCalibrationKind::linear ? ", one line" : ", monotone calibration";
  text += ": FWHM " + with_error(residual.quantile_fwhm) + " mm (quantiles)";
  if (residual.fit.converged) text += ", " + with_error(residual.gaussian_fwhm) + " mm (Gaussian)";
  return text + ", bias " + with_error(residual.mean) + " mm, " + std::to_string(residual.count) +
         " events evaluated";
}

std::string flood_text(const analysis::FloodMap& flood) {
  std::string text = std::to_string(flood.peaks.size()) + " peaks";
  if (!flood.crystals.empty()) {
    text += " for " + std::to_string(flood.crystals.size()) + " parts with interactions";
    if (flood.crystals_without_peak > 0)
      text += " (" + std::to_string(flood.crystals_without_peak) + " without a peak of their own)";
    text += ", " + percent_with_error(flood.share_right) + " of the events assigned rightly";
  }
  if (flood.peak_to_valley > 0.0)
    text += ", peak to valley " + compact(flood.peak_to_valley, 3) + " (worst neighbours " +
            compact(flood.worst_peak_to_valley, 3) + ")";
  return text;
}

std::string spread_text(const analysis::Spread& differences) {
  std::string text = "FWHM ";
  if (differences.fit.converged) text += picoseconds(differences.gaussian_fwhm) + " (Gaussian), ";
  text += picoseconds(differences.quantile_fwhm) + " (quantiles), mean " + picoseconds(differences.mean) +
          ", " + std::to_string(differences.count) + " differences";
  if (differences.fit.converged) text += "; " + goodness_text(differences.fit.goodness);
  return text;
}

std::string timing_depth_text(const analysis::TimingDepth& timing) {
  return "mean time changes by " + picoseconds(timing.line.slope) + " per mm";
}

std::string order_text(const analysis::OrderAnalysis& orders,
                       const std::optional<analysis::TimingBound>& bound) {
  const analysis::OrderTiming& first = orders.single.front();
  std::string text = fmt::format("photon {} at {}, CTR by it {}", first.n, picoseconds(first.mean_ns),
                                 picoseconds(first.ctr_fwhm_ns));
  const auto best = [&](const std::vector<analysis::OrderTiming>& all, std::size_t at,
                        const std::string& what) {
    if (!all.empty())
      text += fmt::format("; best {} {}: {}", what, all[at].n, picoseconds(all[at].ctr_fwhm_ns));
  };
  best(orders.single, orders.best_single, "single photon");
  best(orders.average, orders.best_average, "mean of the first");
  if (bound)
    text +=
        fmt::format("; bound by all {:.0f} photons {:.3g} ps (emission and the sensors' time spread alone)",
                    bound->photons, 1e3 * bound->all_ns);
  return text;
}

std::string order_list(const analysis::OrderAnalysis& orders,
                       const std::optional<analysis::TimingBound>& bound) {
  std::string text;
  for (std::size_t i = 0; i < orders.single.size(); ++i) {
    text += fmt::format("{}n = {}: {}", i == 0 ? "" : ", ", orders.single[i].n,
                        picoseconds(orders.single[i].ctr_fwhm_ns));
    if (bound) text += fmt::format(" (bound {:.3g})", 1e3 * bound->first_ns[i]);
  }
  return text;
}

std::string order_depth_text(const analysis::EventAnalysis& analysis) {
  std::string text;
  for (std::size_t i = 0; i < analysis.orders_against_depth.size(); ++i) {
    const analysis::OrderSlice& slice = analysis.orders_against_depth[i];
    const analysis::OrderTiming& best = slice.orders.single[slice.orders.best_single];
    text += fmt::format("{}{} mm: photon {}, {}", i == 0 ? "" : ", ", compact(slice.depth_mm, 3), best.n,
                        picoseconds(best.ctr_fwhm_ns));
    if (analysis.depth_bounds[i])
      text += fmt::format(" (bound by all {:.3g})", 1e3 * analysis.depth_bounds[i]->all_ns);
  }
  return "best photon at each depth: " + text;
}

std::string layers_text(const analysis::Confusion& confusion) {
  return percent_with_error(confusion.share_right()) + " of the events assigned the right of " +
         std::to_string(confusion.classes) + " layers";
}

}  // namespace scintray::report
