#include "scintray/report/plots/goniometer_plots.hpp"

#include <cmath>

#include "scintray/optics/fresnel.hpp"

namespace scintray::report {

PlotSeries profile_series(const std::string& label, const analysis::DirectionCounts& counts,
                          const analysis::GoniometerSettings& settings) {
  PlotSeries series;
  series.label = label;
  series.steps = true;
  const double solid_angle = analysis::profile_bin_sr(settings.profile_half_width_rad);
  for (std::size_t k = 0; k < counts.profile.size(); ++k)
    series.y.push_back(analysis::density_per_sr(counts.profile[k], settings.rays, solid_angle).value);
  for (int k = 0; k <= analysis::DirectionCounts::kProfileBins; ++k)
    series.x.push_back(analysis::profile_edge_deg(k));
  return series;
}

PlotSeries measured_series(const std::string& label, const analysis::MeasuredProfile& measured) {
  PlotSeries series;
  series.label = label;
  series.x = measured.angle_deg;
  series.y = measured.value;
  series.error = measured.error;
  series.joined = false;
  return series;
}

Plot profile_plot(const std::string& title) {
  Plot plot;
  plot.title = title;
  plot.x_label = "angle in the plane of incidence (deg), forward positive";
  plot.y_label = "share of the light per sr";
  plot.x_low = -90.0;
  plot.x_high = 90.0;
  plot.x_step = 15.0;
  plot.legend_above = true;
  return plot;
}

PlotSeries reflectance_series(const std::string& label,
                              const std::vector<analysis::GoniometerReading>& readings) {
  PlotSeries series;
  series.label = label;
  series.marks = false;
  for (const analysis::GoniometerReading& reading : readings) {
    series.x.push_back(reading.settings.incidence_rad / core::kDegree);
    series.y.push_back(reading.reflectance().value);
  }
  return series;
}

PlotSeries fresnel_series(const std::string& label, double n1, double n2) {
  PlotSeries series;
  series.label = label;
  series.marks = false;
  series.dashed = true;
  constexpr double kStep_deg = 0.25;
  for (double angle = 0.0; angle <= 90.0; angle += kStep_deg) {
    series.x.push_back(angle);
    series.y.push_back(optics::fresnel(std::max(0.0, std::cos(angle * core::kDegree)), n1, n2).unpolarised());
  }
  return series;
}

Plot incidence_plot(const std::string& title, const std::string& y_label) {
  Plot plot;
  plot.title = title;
  plot.x_label = "incidence (deg)";
  plot.y_label = y_label;
  plot.x_low = 0.0;
  plot.x_high = 90.0;
  plot.x_step = 15.0;
  plot.legend_above = true;
  return plot;
}

}  // namespace scintray::report
