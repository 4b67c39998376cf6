#include "scintray/report/light_curves.hpp"

#include <algorithm>

#include "scintray/report/format.hpp"
#include "scintray/report/html_parts.hpp"
#include "scintray/report/svg_plot.hpp"

namespace scintray::report {

namespace {

bool any_events(const std::vector<EventStudy>& studies) {
  return std::any_of(studies.begin(), studies.end(),
                     [](const EventStudy& study) { return study.events > 0; });
}

std::string unit_of_light(const std::vector<EventStudy>& studies) {
  const bool charge =
      std::any_of(studies.begin(), studies.end(), [](const EventStudy& study) { return study.has_readout; });
  return charge ? "photoelectrons" : "photons";
}

std::string name_of(const SweepSeries& series, const std::vector<LightOutput>& light) {
  const std::string how = light[series.points.front()].from_peak ? "photopeak" : "mean";
  return series.label.empty() ? how : series.label + " (" + how + ")";
}

}  // namespace

std::vector<LightOutput> light_outputs(const SweepView& view, const std::vector<EventStudy>& studies) {
  std::vector<LightOutput> light(studies.size());
  for (const SweepSeries& series : view.series) {
    const bool peaks = std::all_of(series.points.begin(), series.points.end(), [&](std::size_t point) {
      return studies.at(point).peak.has_numbers() && studies[point].peak.locates_peak();
    });
    for (const std::size_t point : series.points)
      light[point] = {peaks ? studies[point].peak.fit.position : studies[point].mean_light, peaks};
  }
  return light;
}

std::vector<std::vector<std::string>> light_table(const SweepView& view,
                                                  const std::vector<EventStudy>& studies) {
  if (!any_events(studies)) return {};
  const std::vector<LightOutput> light = light_outputs(view, studies);
  std::vector<std::vector<std::string>> rows{{view.key}};
  for (const SweepSeries& series : view.series) rows.front().push_back(name_of(series, light));
  for (std::size_t r = 0; r < view.rows.size(); ++r) {
    rows.push_back({view.rows[r]});
    for (const SweepSeries& series : view.series) {
      const auto found = std::find(series.x.begin(), series.x.end(), view.row_values[r]);
      const auto at = static_cast<std::size_t>(found - series.x.begin());
      rows.back().push_back(found == series.x.end() ? "-" : with_error(light[series.points[at]].light));
    }
  }
  return rows;
}

std::string light_section(const SweepView& view, const std::vector<EventStudy>& studies) {
  if (!any_events(studies)) return "";
  const std::vector<LightOutput> light = light_outputs(view, studies);
  Plot plot;
  plot.title = "Light output of events against " + view.key;
  plot.x_label = view.key + (view.unit.empty() ? "" : " (" + view.unit + ")");
  plot.y_label = unit_of_light(studies);
  for (const SweepSeries& series : view.series) {
    PlotSeries drawn;
    drawn.label = name_of(series, light);
    drawn.x = series.x;
    for (const std::size_t point : series.points) {
      drawn.y.push_back(light[point].light.value);
      drawn.error.push_back(light[point].light.error);
    }
    plot.series.push_back(std::move(drawn));
  }
  const std::vector<std::vector<std::string>> rows = light_table(view, studies);
  std::string body;
  for (std::size_t r = 1; r < rows.size(); ++r) {
    body += "<tr>" + cell(rows[r].front(), "th");
    for (std::size_t i = 1; i < rows[r].size(); ++i) body += number_cell(rows[r][i]);
    body += "</tr>\n";
  }
  return section(
      "Light output of events",
      "<figure>" + svg_plot(plot) + "<figcaption>" + unit_of_light(studies) +
          " detected per event: the position of the photopeak where it is found at every point of a "
          "curve, else the mean of the pulses. Bars show one standard error.</figcaption></figure>\n" +
          table(rows.front(), body));
}

}  // namespace scintray::report
