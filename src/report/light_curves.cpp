#include "scintray/report/light_curves.hpp"

#include <algorithm>
#include <functional>

#include "scintray/report/format.hpp"
#include "scintray/report/html_parts.hpp"
#include "scintray/report/svg_plot.hpp"

namespace scintray::report {

namespace {

/// Energy at which light is given: that of annihilation photons.
constexpr double kReference_keV = 510.99895;

using LightOf = std::function<Estimate(const EventStudy&)>;

Estimate photopeak_of(const EventStudy& study) { return study.peak.fit.position; }

bool any_events(const std::vector<EventStudy>& studies) {
  return std::any_of(studies.begin(), studies.end(),
                     [](const EventStudy& study) { return study.events > 0; });
}

bool has_peaks(const SweepSeries& series, const std::vector<EventStudy>& studies) {
  return std::all_of(series.points.begin(), series.points.end(), [&](std::size_t point) {
    return studies.at(point).peak.has_numbers() && studies[point].peak.locates_peak();
  });
}

std::string unit_of(const std::vector<EventStudy>& studies) {
  const bool charge =
      std::any_of(studies.begin(), studies.end(), [](const EventStudy& study) { return study.has_readout; });
  return charge ? "photoelectrons" : "photons";
}

/// What light is divided by.
double scale_of(const SweepView& view, const std::vector<EventStudy>& studies, const NameRef& reference,
                const LightOf& light) {
  if (reference.empty()) return 1.0;
  std::vector<std::string> labels;
  for (const SweepSeries& series : view.series) {
    if (series.label == reference.name) return light(studies.at(series.points.front())).value;
    labels.push_back(series.label);
  }
  throw unknown_name(reference.where, "curve", reference.name, labels);
}

Estimate scaled(const Estimate& light, double scale) { return {light.value / scale, light.error / scale}; }

std::string figure(const SweepView& view, const std::vector<EventStudy>& studies, const NameRef& reference,
                   const std::string& what, const LightOf& light, bool peaks_only) {
  const double scale = scale_of(view, studies, reference, light);
  if (!(scale > 0.0)) return "";
  Plot plot;
  plot.title = what + " against " + view.key;
  plot.x_label = view.key + (view.unit.empty() ? "" : " (" + view.unit + ")");
  plot.y_label = reference.empty() ? unit_of(studies) : "of " + reference.name;
  plot.legend_above = view.series.size() > 4;
  for (const SweepSeries& series : view.series) {
    if (peaks_only && !has_peaks(series, studies)) continue;
    PlotSeries drawn;
    drawn.label = series.label;
    drawn.x = series.x;
    for (const std::size_t point : series.points) {
      const Estimate value = scaled(light(studies.at(point)), scale);
      drawn.y.push_back(value.value);
      drawn.error.push_back(value.error);
    }
    plot.series.push_back(std::move(drawn));
  }
  if (plot.series.empty()) return "";
  return "<figure>" + svg_plot(plot) + "<figcaption>" + escape_html(what) + " against " +
         escape_html(view.key) + ". Bars show one standard error.</figcaption></figure>\n";
}

}  // namespace

Estimate light_of(const EventStudy& study) {
  return {kReference_keV * study.light_per_keV.value, kReference_keV * study.light_per_keV.error};
}

std::vector<std::vector<std::string>> light_table(const SweepView& view,
                                                  const std::vector<EventStudy>& studies,
                                                  const NameRef& reference) {
  if (!any_events(studies)) return {};
  const double scale = scale_of(view, studies, reference, light_of);
  std::vector<std::vector<std::string>> rows{{view.key}};
  for (const SweepSeries& series : view.series)
    rows.front().push_back(series.label.empty() ? unit_of(studies) + " at 511 keV" : series.label);
  for (std::size_t r = 0; r < view.rows.size(); ++r) {
    rows.push_back({view.rows[r]});
    for (const SweepSeries& series : view.series) {
      const auto found = std::find(series.x.begin(), series.x.end(), view.row_values[r]);
      const auto at = static_cast<std::size_t>(found - series.x.begin());
      rows.back().push_back(
          found == series.x.end() ? "-" : with_error(scaled(light_of(studies.at(series.points[at])), scale)));
    }
  }
  return rows;
}

std::string light_section(const SweepView& view, const std::vector<EventStudy>& studies,
                          const NameRef& reference) {
  if (!any_events(studies)) return "";
  const std::vector<std::vector<std::string>> rows = light_table(view, studies, reference);
  std::string body;
  for (std::size_t r = 1; r < rows.size(); ++r) {
    body += "<tr>" + cell(rows[r].front(), "th");
    for (std::size_t i = 1; i < rows[r].size(); ++i) body += number_cell(rows[r][i]);
    body += "</tr>\n";
  }
  return section(
      "Light output of events",
      figure(view, studies, reference, "Light at 511 keV, of all events over their energy", light_of, false) +
          table(rows.front(), body) +
          figure(view, studies, reference, "Position of the photopeak, where it is found at every point",
                 photopeak_of, true));
}

}  // namespace scintray::report
