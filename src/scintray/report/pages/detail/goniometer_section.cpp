#include "scintray/report/pages/detail/sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scintray/report/pages/detail/html_parts.hpp"
#include "scintray/report/plots/detail/hemisphere_map.hpp"
#include "scintray/report/plots/goniometer_plots.hpp"
#include "scintray/report/text/format.hpp"

namespace scintray::report {

namespace {

constexpr double kPlotHeight = 420.0;
constexpr double kSlopeStep_deg = 5.0;

PlotSeries series_of(const analysis::SurfaceAnalysis& analysis, const std::vector<core::Estimate>& estimates,
                     double unit) {
  PlotSeries series;
  series.label = analysis.place.surface;
  series.marks = false;
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    series.x.push_back(analysis.incidence_rad[i] / core::kDegree);
    series.y.push_back(estimates[i].value / unit);
  }
  return series;
}

std::string figure(Plot plot, const std::string& caption) {
  plot.height = kPlotHeight;
  return "<figure>" + chart(plot) + "<figcaption>" + escape_html(caption) + "</figcaption></figure>\n";
}

using Analyses = std::vector<const analysis::SurfaceAnalysis*>;

/// Facets do not depend on the medium behind them, so each surface is drawn once.
std::string slope_figure(const Analyses& analyses) {
  Plot plot = incidence_plot("Mean visible slope against incidence", "mean visible slope (deg)");
  std::vector<std::string> drawn;
  double highest = 0.0;
  for (const analysis::SurfaceAnalysis* analysis : analyses) {
    if (analysis->slope_rad.empty() || std::count(drawn.begin(), drawn.end(), analysis->place.surface) > 0)
      continue;
    drawn.push_back(analysis->place.surface);
    plot.series.push_back(series_of(*analysis, analysis->slope_rad, core::kDegree));
    for (const double slope : plot.series.back().y) highest = std::max(highest, slope);
  }
  if (drawn.empty()) return "";
  plot.y_high = kSlopeStep_deg * std::ceil(highest / kSlopeStep_deg);
  return figure(plot, "Mean angle between the mean normal and the first facet that light from inside hits.");
}

std::string reflectance_figure(const Analyses& analyses) {
  const analysis::SurfaceAnalysis& first = *analyses.front();
  Plot plot = incidence_plot("Reflectance against incidence into " + first.place.outside, "reflectance");
  plot.y_high = 1.0;
  for (const analysis::SurfaceAnalysis* analysis : analyses)
    plot.series.push_back(series_of(*analysis, analysis->reflectance, 1.0));
  plot.series.push_back(fresnel_series("Fresnel, flat", first.index.inside, first.index.outside));
  return figure(
      plot, fmt::format("Reflectance from {} (n {:.4g}) to {} (n {:.4g}), {:g} nm, {} rays at each angle.",
                        first.place.inside, first.index.inside, first.place.outside, first.index.outside,
                        first.place.wavelength_nm, grouped(first.rays)));
}

std::string direction_maps(const Analyses& analyses) {
  std::string maps;
  for (const analysis::SurfaceAnalysis* analysis : analyses) {
    const analysis::GoniometerReading& reading = analysis->directions;
    if (reading.reflected == 0) continue;
    const double width = std::asin(std::min(1.0, reading.reflected_lobe.width_in_plane)) / core::kDegree;
    const std::string caption =
        fmt::format("{} to {}: reflected {}, rms width in plane {:.3g} deg", analysis->place.surface,
                    analysis->place.outside, with_error(reading.reflectance()), width);
    maps += "<figure><figcaption>" + escape_html(caption) + "</figcaption>\n" +
            hemisphere_map(reading.reflected_directions, reading.settings.rays,
                           reading.settings.incidence_rad, caption) +
            "</figure>\n";
  }
  if (maps.empty()) return "";
  const double incidence = analyses.front()->directions.settings.incidence_rad / core::kDegree;
  return fmt::format(
             "<h3>Directions of reflected light at {:g} deg</h3>\n<p class=\"under\">The distance from the "
             "centre is the angle to the normal (circles at 30, 60 and 90 deg), forward is to the right, the "
             "cross is the direction of light from a flat face; shares per steradian.</p>\n",
             incidence) +
         "<div class=\"grid\">\n" + maps + "</div>\n";
}

/// Groups of consecutive readings for which `same` is true.
template <typename Same>
std::vector<Analyses> grouped_by(const Analyses& analyses, Same&& same) {
  std::vector<Analyses> groups;
  for (const analysis::SurfaceAnalysis* analysis : analyses) {
    if (groups.empty() || !same(*groups.back().front(), *analysis)) groups.emplace_back();
    groups.back().push_back(analysis);
  }
  return groups;
}

std::string goniometer_section(const Analyses& analyses) {
  std::string body = slope_figure(analyses);
  for (const Analyses& place :
       grouped_by(analyses, [](const analysis::SurfaceAnalysis&a, const analysis::SurfaceAnalysis&b) {
         return a.place.outside == b.place.outside;
       }))
    body += reflectance_figure(place);
  return section(analyses.front()->goniometer, body + direction_maps(analyses));
}

}  // namespace

std::string goniometer_sections(const std::vector<analysis::SurfaceAnalysis>& analyses) {
  Analyses all;
  for (const analysis::SurfaceAnalysis& analysis : analyses) all.push_back(&analysis);
  std::string sections;
  for (const Analyses& goniometer :
       grouped_by(all, [](const analysis::SurfaceAnalysis&a, const analysis::SurfaceAnalysis&b) {
         return a.goniometer == b.goniometer;
       }))
    sections += goniometer_section(goniometer);
  return sections;
}

}  // namespace scintray::report
