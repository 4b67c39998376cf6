#include "scintray/report/plots/detail/light_curves.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include "scintray/core/constants.hpp"
#include "scintray/report/pages/detail/html_parts.hpp"
#include "scintray/report/plots/svg_plot.hpp"
#include "scintray/report/text/format.hpp"

namespace scintray::report {

namespace {

using LightOf = std::function<core::Estimate(const analysis::EventAnalysis&)>;

core::Estimate photopeak_of(const analysis::EventAnalysis& analysis) { return analysis.peak.fit.position; }

bool any_events(const std::vector<analysis::EventAnalysis>& analyses) {
  return std::any_of(analyses.begin(), analyses.end(),
                     [](const analysis::EventAnalysis& analysis) { return analysis.events > 0; });
}

bool has_peaks(const SweepSeries& series, const std::vector<analysis::EventAnalysis>& analyses) {
  return std::all_of(series.points.begin(), series.points.end(), [&](std::size_t point) {
    return analyses.at(point).peak.has_numbers() && analyses[point].peak.locates_peak();
  });
}

std::string unit_of(const std::vector<analysis::EventAnalysis>& analyses) {
  const bool charge =
      std::any_of(analyses.begin(), analyses.end(),
                  [](const analysis::EventAnalysis& analysis) { return analysis.has_readout; });
  return charge ? "photoelectrons" : "photons";
}

/// Divisor of the light.
double scale_of(const SweepView& view, const std::vector<analysis::EventAnalysis>& analyses,
                const config::NameRef& reference, const LightOf& light) {
  if (reference.empty()) return 1.0;
  std::vector<std::string> labels;
  for (const SweepSeries& series : view.series) {
    if (series.label == reference.name) return light(analyses.at(series.points.front())).value;
    labels.push_back(series.label);
  }
  throw core::unknown_name(reference.where, "curve", reference.name, labels);
}

core::Estimate scaled(const core::Estimate& light, double scale) {
  return {light.value / scale, light.error / scale};
}

/// Limit of the curves in one plot.
constexpr std::size_t kMostCurves = 6;

/// The setting of the slowest key, where a run has more curves than fit in one plot; else empty.
std::string group_of(const SweepView& view, const SweepSeries& series) {
  if (view.series.size() <= kMostCurves) return "";
  const auto comma = series.label.find(", ");
  return comma == std::string::npos ? "" : series.label.substr(0, comma);
}

PlotSeries curve(const SweepSeries& series, const std::vector<analysis::EventAnalysis>& analyses,
                 const LightOf& light, double scale, const std::string& group) {
  PlotSeries drawn;
  drawn.label = group.empty() ? series.label : series.label.substr(group.size() + 2);
  drawn.x = series.x;
  for (const std::size_t point : series.points) {
    const core::Estimate value = scaled(light(analyses.at(point)), scale);
    drawn.y.push_back(value.value);
    drawn.error.push_back(value.error);
  }
  return drawn;
}

/// A plot for each group of curves, all with the same upper end.
std::string figures(const SweepView& view, const std::vector<analysis::EventAnalysis>& analyses,
                    const config::NameRef& reference, const std::string& what, const LightOf& light,
                    bool peaks_only) {
  const double scale = scale_of(view, analyses, reference, light);
  if (!(scale > 0.0)) return "";
  std::vector<std::pair<std::string, std::vector<PlotSeries>>> groups;
  double highest = 0.0;
  for (const SweepSeries& series : view.series) {
    if (peaks_only && !has_peaks(series, analyses)) continue;
    const std::string group = group_of(view, series);
    if (groups.empty() || groups.back().first != group) groups.push_back({group, {}});
    groups.back().second.push_back(curve(series, analyses, light, scale, group));
    for (const double y : groups.back().second.back().y) highest = std::max(highest, y);
  }
  std::string out;
  for (auto& [group, curves] : groups) {
    Plot plot;
    plot.title = what + " against " + view.key;
    plot.x_label = view.key + (view.unit.empty() ? "" : " (" + view.unit + ")");
    plot.y_label = reference.empty() ? unit_of(analyses) : "relative";
    plot.y_high = highest;
    plot.legend_above = curves.size() > 4;
    plot.height = plot.legend_above ? 480.0 : 380.0;
    plot.series = std::move(curves);
    const std::string unit =
        reference.empty() ? "" : ", in units of " + reference.name + " at its first point";
    out += "<figure>" + chart(plot) + "<figcaption>" +
           escape_html((group.empty() ? "" : group + ": ") + what + unit) +
           ". Bars show one standard error.</figcaption></figure>\n";
  }
  return out;
}

}  // namespace

core::Estimate light_of(const analysis::EventAnalysis& analysis) {
  return {core::kElectronMass_keV * analysis.light_per_keV.value,
          core::kElectronMass_keV * analysis.light_per_keV.error};
}

std::vector<std::vector<std::string>> light_table(const SweepView& view,
                                                  const std::vector<analysis::EventAnalysis>& analyses,
                                                  const config::NameRef& reference) {
  if (!any_events(analyses)) return {};
  const double scale = scale_of(view, analyses, reference, light_of);
  std::vector<std::vector<std::string>> rows{{view.key}};
  for (const SweepSeries& series : view.series)
    rows.front().push_back(series.label.empty() ? unit_of(analyses) + " at 511 keV" : series.label);
  for (std::size_t r = 0; r < view.rows.size(); ++r) {
    rows.push_back({view.rows[r]});
    for (const SweepSeries& series : view.series) {
      const auto found = std::find(series.x.begin(), series.x.end(), view.row_values[r]);
      const auto at = static_cast<std::size_t>(found - series.x.begin());
      rows.back().push_back(found == series.x.end()
                                ? "-"
                                : with_error(scaled(light_of(analyses.at(series.points[at])), scale)));
    }
  }
  return rows;
}

std::vector<std::vector<std::string>> upright(const std::vector<std::vector<std::string>>& table,
                                              std::size_t most) {
  if (table.empty() || table.front().size() <= most) return table;
  std::vector<std::vector<std::string>> turned(table.front().size());
  for (const auto& row : table)
    for (std::size_t i = 0; i < row.size(); ++i) turned[i].push_back(row[i]);
  return turned;
}

std::string light_section(const SweepView& view, const std::vector<analysis::EventAnalysis>& analyses,
                          const config::NameRef& reference) {
  if (!any_events(analyses)) return "";
  const std::vector<std::vector<std::string>> rows =
      upright(light_table(view, analyses, reference), kMostCurves);
  std::string body;
  for (std::size_t r = 1; r < rows.size(); ++r) {
    body += "<tr>" + cell(rows[r].front(), "th");
    for (std::size_t i = 1; i < rows[r].size(); ++i) body += number_cell(rows[r][i]);
    body += "</tr>\n";
  }
  return section(
      "Light output of events",
      figures(view, analyses, reference, "Light at 511 keV, of all events over their energy", light_of,
              false) +
          table(rows.front(), body) +
          figures(view, analyses, reference, "Position of the photopeak, where it is found at every point",
                  photopeak_of, true));
}

}  // namespace scintray::report
