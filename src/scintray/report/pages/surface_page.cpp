#include "scintray/report/pages/pages.hpp"

#include "scintray/core/text.hpp"
#include "scintray/report/pages/page.hpp"
#include "scintray/report/plots/goniometer_plots.hpp"
#include "scintray/report/text/format.hpp"

namespace scintray::report {

namespace {

constexpr const char* kSurfaceStyle = R"css(
body { max-width: 80rem; }
.cards { display: grid; grid-template-columns: repeat(auto-fill, minmax(34rem, 1fr)); gap: 1.75rem; margin-top: 2rem; }
.card { border: 1px solid var(--rule); border-radius: 6px; padding: .9rem 1rem; break-inside: avoid; }
.card h2 { margin: 0; border: 0; padding: 0; font-size: 1.05rem; overflow-wrap: anywhere; }
.card p { margin: .2rem 0; font-size: .85rem; color: var(--soft); overflow-wrap: anywhere; }
.card p.needs { color: var(--ink); }
.plots { display: grid; grid-template-columns: 1fr 1fr; gap: .75rem; margin-top: .5rem; }
@media (max-width: 40rem) { .cards, .plots { grid-template-columns: 1fr; } }
)css";

constexpr double kPlotWidth = 460.0, kPlotHeight = 320.0;

std::string small(Plot plot) {
  plot.width = kPlotWidth;
  plot.height = kPlotHeight;
  return "<figure>" + chart(plot) + "</figure>\n";
}

std::string incidence(const SurfaceReadings& readings, const std::string& name) {
  Plot plot = incidence_plot("Shares against incidence, " + name, "share of the light");
  plot.x_label = "incidence from inside (deg)";
  plot.x_step = 30.0;
  plot.y_high = 1.0;
  plot.series.push_back(reflectance_series("reflected", readings.sweep));
  plot.series.push_back(
      fresnel_series("Fresnel", readings.sample.index.inside, readings.sample.index.outside));
  PlotSeries absorbed = plot.series.front();
  absorbed.label = "absorbed";
  bool any = false;
  for (std::size_t k = 0; k < readings.sweep.size(); ++k) {
    absorbed.y[k] = readings.sweep[k].absorptance().value;
    any = any || readings.sweep[k].absorbed > 0;
  }
  if (any) plot.series.push_back(absorbed);
  return small(plot);
}

std::string profile(const SurfaceReadings& readings, const std::string& name) {
  const analysis::GoniometerReading& reading = readings.profile;
  const std::string angle = compact(reading.settings.incidence_rad / core::kDegree, 4) + " deg";
  Plot plot = profile_plot("In-plane profile at " + angle + ", " + name);
  plot.x_label = "in-plane angle (deg), incidence " + angle;
  plot.y_label = "share per sr";
  plot.x_step = 30.0;
  if (reading.reflected > 0)
    plot.series.push_back(profile_series("reflected", reading.reflected_directions, reading.settings));
  if (reading.transmitted > 0)
    plot.series.push_back(profile_series("transmitted", reading.transmitted_directions, reading.settings));
  return plot.series.empty() ? "" : small(plot);
}

std::string card(const SurfaceEntry& entry) {
  const materials::SurfaceOutline& outline = entry.outline;
  std::string out = "<article class=\"card\">\n<h2>" + escape_html(entry.name) + "</h2>\n<p>model " +
                    escape_html(outline.model);
  if (!outline.bases.empty()) out += ", based on " + escape_html(core::list_of(outline.bases, ", "));
  out += "</p>\n<p>" + escape_html(core::list_of(outline.sources, "; ")) + "</p>\n";
  if (!outline.needs.empty())
    out += "<p class=\"needs\">required parameters: " + escape_html(core::list_of(outline.needs, ", ")) +
           "</p>\n";
  if (entry.readings)
    out += "<div class=\"plots\">\n" + incidence(*entry.readings, entry.name) +
           profile(*entry.readings, entry.name) + "</div>\n";
  else if (outline.needs.empty())
    out += "<p class=\"needs\">not made here: " + escape_html(entry.not_made) + "</p>\n";
  return out + "</article>\n";
}

}  // namespace

std::string surface_page(const std::vector<SurfaceEntry>& entries, const std::string& under) {
  std::string body = "<div class=\"cards\">\n";
  for (const bool made : {true, false})  // those that show something first
    for (const SurfaceEntry& entry : entries)
      if (entry.readings.has_value() == made) body += card(entry);
  return html_page("Surfaces of the material database", under, kSurfaceStyle, body + "</div>\n");
}

}  // namespace scintray::report
