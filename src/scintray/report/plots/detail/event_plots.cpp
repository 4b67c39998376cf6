#include "scintray/report/plots/detail/event_plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace scintray::report {

namespace {

constexpr double kPicoseconds = 1e3;
constexpr double kEventPlotWidth = 560.0, kEventPlotHeight = 320.0;
constexpr int kCurvePoints = 160;

Plot small_plot(const std::string& title, const std::string& x, const std::string& y) {
  Plot plot;
  plot.title = title;
  plot.x_label = x;
  plot.y_label = y;
  plot.width = kEventPlotWidth;
  plot.height = kEventPlotHeight;
  plot.legend_above = true;
  return plot;
}

PlotSeries histogram_series(const std::string& label, const analysis::Histogram& histogram, double scale) {
  PlotSeries series{label, histogram.edges(), histogram.counts, {}, true};
  for (double& edge : series.x) edge *= scale;
  return series;
}

/// A model's counts per bin of `width`, over the bins it was fitted to.
PlotSeries model_series(const analysis::PeakModel& model, const analysis::Histogram& fitted, double width,
                        double scale) {
  PlotSeries series;
  series.label = "fit";
  series.marks = false;
  for (int i = 0; i <= kCurvePoints; ++i) {
    const double x = fitted.low + (fitted.high() - fitted.low) * i / kCurvePoints;
    series.x.push_back(scale * x);
    series.y.push_back(width * model.density(x));
  }
  return series;
}

template <typename Items>
PlotSeries points_series(const std::string& label, const Items& items,
                         const std::function<double(const typename Items::value_type&)>& x,
                         const std::function<core::Estimate(const typename Items::value_type&)>& y,
                         double scale = 1.0) {
  PlotSeries series;
  series.label = label;
  for (const auto& item : items) {
    series.x.push_back(x(item));
    series.y.push_back(scale * y(item).value);
    series.error.push_back(scale * y(item).error);
  }
  return series;
}

}  // namespace

std::string light_unit(const analysis::EventAnalysis& analysis) {
  return analysis.has_readout ? "photoelectrons" : "photons";
}

Plot spectrum_plot(const analysis::EventAnalysis& analysis) {
  Plot plot =
      small_plot("energy spectrum", "light of a pulse (" + light_unit(analysis) + ")", "pulses per bin");
  plot.series.push_back(histogram_series("pulses", *analysis.spectrum, 1.0));
  if (analysis.light_per_keV.value > 0.0) {
    plot.top = TopAxis{"energy (keV), at the mean light per keV", analysis.light_per_keV.value};
    plot.height += 46.0;
  }
  if (analysis.peak.has_numbers())
    plot.series.push_back(
        model_series(analysis.peak.fit.model, analysis.peak.fitted, analysis.spectrum->width, 1.0));
  return plot;
}

Plot depth_plot(const analysis::DepthCurve& curve) {
  Plot plot = small_plot("light against depth", "depth (mm)", "light, relative");
  plot.y_from_zero = false;
  PlotSeries points;
  points.joined = false;
  points.label = curve.points.front().from_peak ? "photopeak" : "mean";
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    points.x.push_back(curve.points[i].depth_mm);
    points.y.push_back(curve.relative[i].value);
    points.error.push_back(curve.relative[i].error);
  }
  plot.series.push_back(points);
  if (curve.points.size() < 2) return plot;
  PlotSeries line{"line", {points.x.front(), points.x.back()}, {}, {}};
  line.marks = false;
  line.dashed = true;
  for (const double x : line.x)
    line.y.push_back(curve.line.at(x).value / curve.points[curve.reference].value.value);
  plot.series.push_back(line);
  return plot;
}

Plot doi_plot(const analysis::DoiAnalysis& doi) {
  Plot plot = small_plot("depth of interaction", "true depth (mm)", "mm");
  plot.y_from_zero = false;
  const auto depth = [](const analysis::DoiSlice& slice) { return slice.depth_mm; };
  plot.series.push_back(points_series("FWHM", doi.slices, depth,
                                      [](const analysis::DoiSlice& slice) { return slice.fwhm_mm; }));
  plot.series.push_back(points_series("bias", doi.slices, depth,
                                      [](const analysis::DoiSlice& slice) { return slice.bias_mm; }));
  return plot;
}

std::string small_spectrum(const analysis::PartLight& part) {
  constexpr double kWide = 120.0, kHigh = 26.0;
  constexpr std::size_t kMostBins = 60;
  if (!part.spectrum || part.spectrum->counts.empty()) return "";
  const std::vector<double>& counts = part.spectrum->counts;
  const std::size_t joined = (counts.size() + kMostBins - 1) / kMostBins;
  std::vector<double> bars;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (i % joined == 0) bars.push_back(0.0);
    bars.back() += counts[i];
  }
  const double most = std::max(*std::max_element(bars.begin(), bars.end()), 1.0);
  std::string path = fmt::format("M0 {:.0f}", kHigh);
  for (std::size_t i = 0; i < bars.size(); ++i)
    path += fmt::format("V{:.1f}H{:.1f}", kHigh * (1.0 - bars[i] / most),
                        kWide * static_cast<double>(i + 1) / static_cast<double>(bars.size()));
  return fmt::format(
      "<svg class=\"small-spectrum\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "role=\"img\" aria-label=\"spectrum from {2:.4g} to {3:.4g}\"><path d=\"{4}V{1:.0f}Z\"/></svg>",
      kWide, kHigh, part.spectrum->low, part.spectrum->high(), path);
}

std::size_t part_number(const analysis::EventAnalysis& analysis, core::PartId part) {
  const auto found = std::find_if(analysis.parts.begin(), analysis.parts.end(),
                                  [&](const analysis::PartLight& one) { return one.part == part; });
  return static_cast<std::size_t>(found - analysis.parts.begin()) + 1;
}

namespace {

/// "x (mm)" for a direction along an axis of the world; else "across, 1st direction (mm)".
std::string across_label(const core::Vec3& direction, const char* otherwise) {
  static const char* const kAxes[] = {"x", "y", "z"};
  for (Eigen::Index k = 0; k < 3; ++k)
    if (std::abs(direction[k]) > 1.0 - 1e-9)
      return std::string(direction[k] < 0.0 ? "-" : "") + kAxes[k] + " by Anger logic (mm)";
  return std::string(otherwise) + " by Anger logic (mm)";
}

/// Borders between cells of different peaks, cells in a row or column joined to one line.
std::vector<std::array<double, 4>> region_borders(const analysis::FloodMap& flood) {
  const analysis::FloodGrid& grid = flood.grid;
  const auto x = [&](std::size_t column) {
    return grid.x_low +
           (grid.x_high - grid.x_low) * static_cast<double>(column) / static_cast<double>(grid.columns);
  };
  const auto y = [&](std::size_t row) {
    return grid.y_low +
           (grid.y_high - grid.y_low) * static_cast<double>(row) / static_cast<double>(grid.rows);
  };
  const auto peak = [&](std::size_t row, std::size_t column) {
    return flood.peak_of_cell[row * grid.columns + column];
  };
  std::vector<std::array<double, 4>> lines;
  // Calls add(first, last) for each longest run of places that differ().
  const auto runs = [](std::size_t count, const auto& differs, const auto& add) {
    for (std::size_t i = 0; i < count; ++i) {
      if (!differs(i)) continue;
      const std::size_t first = i;
      while (i < count && differs(i)) ++i;
      add(first, i);
    }
  };
  for (std::size_t column = 1; column < grid.columns; ++column)
    runs(
        grid.rows, [&](std::size_t row) { return peak(row, column - 1) != peak(row, column); },
        [&](std::size_t low, std::size_t high) {
          lines.push_back({x(column), y(low), x(column), y(high)});
        });
  for (std::size_t row = 1; row < grid.rows; ++row)
    runs(
        grid.columns, [&](std::size_t column) { return peak(row - 1, column) != peak(row, column); },
        [&](std::size_t low, std::size_t high) {
          lines.push_back({x(low), y(row), x(high), y(row)});
        });
  return lines;
}

}  // namespace

GridMap flood_picture(const analysis::EventAnalysis& analysis) {
  constexpr double kLowPeak = 0.2;
  const analysis::FloodMap& flood = *analysis.flood;
  GridMap map;
  map.rows = (flood.grid.rows + 1) / 2;
  map.columns = (flood.grid.columns + 1) / 2;
  map.values.assign(map.rows * map.columns, 0.0);
  for (std::size_t row = 0; row < flood.grid.rows; ++row)
    for (std::size_t column = 0; column < flood.grid.columns; ++column)
      map.values[row / 2 * map.columns + column / 2] += flood.grid.counts[row * flood.grid.columns + column];
  map.x_low = flood.grid.x_low;
  map.x_high = flood.grid.x_low + (flood.grid.x_high - flood.grid.x_low) *
                                      static_cast<double>(2 * map.columns) /
                                      static_cast<double>(flood.grid.columns);
  map.y_low = flood.grid.y_low;
  map.y_high = flood.grid.y_low + (flood.grid.y_high - flood.grid.y_low) * static_cast<double>(2 * map.rows) /
                                      static_cast<double>(flood.grid.rows);
  map.x_label = across_label(analysis.across_x, "first direction across");
  map.y_label = across_label(analysis.across_y, "second direction across");
  map.value_label = "events per cell";
  map.alternative = "flood map";
  map.lines = region_borders(flood);
  double lowest = flood.peaks.empty() ? 0.0 : flood.peaks.front().height, highest = lowest;
  for (const analysis::FloodPeak& peak : flood.peaks) {
    lowest = std::min(lowest, peak.height);
    highest = std::max(highest, peak.height);
    if (flood.crystals.empty()) continue;
    map.marks.push_back({peak.position_mm[0], peak.position_mm[1],
                         std::to_string(part_number(analysis, flood.crystals[peak.owner]))});
  }
  map.logarithmic = lowest < kLowPeak * highest;
  return map;
}

Plot difference_plot(const analysis::Spread& differences, const std::string& label) {
  Plot plot = small_plot(label, label + " (ps)", "per bin");
  plot.series.push_back(histogram_series("simulated", differences.fitted, kPicoseconds));
  if (differences.fit.converged)
    plot.series.push_back(
        model_series(differences.fit.model, differences.fitted, differences.fitted.width, kPicoseconds));
  return plot;
}

Plot timing_depth_plot(const analysis::TimingDepth& timing) {
  Plot plot = small_plot("timing against depth", "depth (mm)", "ps");
  const auto depth = [](const analysis::TimingSlice& slice) { return slice.depth_mm; };
  plot.series.push_back(points_series(
      "CTR (FWHM)", timing.slices, depth,
      [](const analysis::TimingSlice& slice) { return slice.ctr_fwhm_ns; }, kPicoseconds));
  plot.series.push_back(points_series(
      "mean time", timing.slices, depth, [](const analysis::TimingSlice& slice) { return slice.mean_ns; },
      kPicoseconds));
  return plot;
}

namespace {

/// The timing of an analysis by one n; empty when it has none.
const analysis::OrderTiming* timing_by(const std::vector<analysis::OrderTiming>& all, std::size_t n) {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const analysis::OrderTiming& one) { return one.n == n; });
  return found == all.end() ? nullptr : &*found;
}

PlotSeries depth_series(const std::string& label, const std::vector<analysis::OrderSlice>& slices,
                        std::vector<analysis::OrderTiming> analysis::OrderAnalysis::*kind, std::size_t n) {
  PlotSeries series;
  series.label = label;
  for (const analysis::OrderSlice& slice : slices) {
    const analysis::OrderTiming* timing = timing_by(slice.orders.*kind, n);
    if (!timing) continue;
    series.x.push_back(slice.depth_mm);
    series.y.push_back(kPicoseconds * timing->ctr_fwhm_ns.value);
    series.error.push_back(kPicoseconds * timing->ctr_fwhm_ns.error);
  }
  return series;
}

PlotSeries bound_series(const std::string& label) {
  PlotSeries series;
  series.label = label;
  series.marks = false;
  series.dashed = true;
  return series;
}

}  // namespace

Plot order_plot(const analysis::OrderAnalysis& orders, const std::optional<analysis::TimingBound>& bound) {
  Plot plot = small_plot("timing by order of photons", "n", "CTR, FWHM (ps)");
  const auto n = [](const analysis::OrderTiming& timing) { return static_cast<double>(timing.n); };
  const auto ctr = [](const analysis::OrderTiming& timing) { return timing.ctr_fwhm_ns; };
  plot.series.push_back(points_series("n-th photon", orders.single, n, ctr, kPicoseconds));
  if (!orders.average.empty())
    plot.series.push_back(points_series("mean of the first n", orders.average, n, ctr, kPicoseconds));
  if (!bound) return plot;
  PlotSeries line = bound_series("bound by the first n");
  for (std::size_t i = 0; i < orders.single.size(); ++i) {
    line.x.push_back(static_cast<double>(orders.single[i].n));
    line.y.push_back(kPicoseconds * bound->first_ns[i]);
  }
  plot.series.push_back(line);
  return plot;
}

Plot order_depth_plot(const analysis::EventAnalysis& analysis) {
  Plot plot = small_plot("timing by order of photons against depth", "depth (mm)", "CTR, FWHM (ps)");
  const analysis::OrderAnalysis& whole = *analysis.orders;
  const std::vector<analysis::OrderSlice>& slices = analysis.orders_against_depth;
  const auto add = [&](const std::string& label,
                       std::vector<analysis::OrderTiming> analysis::OrderAnalysis::*kind, std::size_t n) {
    PlotSeries series = depth_series(fmt::format(fmt::runtime(label), n), slices, kind, n);
    if (!series.x.empty()) plot.series.push_back(std::move(series));
  };
  add("photon {}", &analysis::OrderAnalysis::single, whole.single.front().n);
  if (whole.best_single > 0)
    add("photon {}", &analysis::OrderAnalysis::single, whole.single[whole.best_single].n);
  if (!whole.average.empty())
    add("mean of the first {}", &analysis::OrderAnalysis::average, whole.average[whole.best_average].n);
  PlotSeries line = bound_series("bound by all");
  for (std::size_t i = 0; i < slices.size(); ++i) {
    if (!analysis.depth_bounds[i]) continue;
    line.x.push_back(slices[i].depth_mm);
    line.y.push_back(kPicoseconds * analysis.depth_bounds[i]->all_ns);
  }
  if (!line.x.empty()) plot.series.push_back(std::move(line));
  return plot;
}

Plot orders_plot(const std::vector<std::pair<std::string, analysis::OrderAnalysis>>& points) {
  Plot plot = small_plot("timing by order of photons", "n", "CTR by the n-th photon, FWHM (ps)");
  for (const auto& [label, orders] : points)
    plot.series.push_back(points_series(
        label, orders.single,
        [](const analysis::OrderTiming& timing) { return static_cast<double>(timing.n); },
        [](const analysis::OrderTiming& timing) { return timing.ctr_fwhm_ns; }, kPicoseconds));
  return plot;
}

}  // namespace scintray::report
