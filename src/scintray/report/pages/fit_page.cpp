#include "scintray/report/pages/pages.hpp"

#include <fmt/format.h>

#include <cctype>

#include "scintray/core/text.hpp"
#include "scintray/report/pages/detail/html_parts.hpp"
#include "scintray/report/pages/page.hpp"
#include "scintray/report/plots/svg_plot.hpp"
#include "scintray/report/text/fit_text.hpp"
#include "scintray/report/text/format.hpp"
#include "scintray/report/text/omissions.hpp"

namespace scintray::report {

namespace {

constexpr const char* kFitStyle = R"css(
.note, .omitted { color: var(--soft); font-size: .9rem; max-width: 48rem; }
figure, .scroll { margin-top: 1.25rem; }
)css";

std::string fit_table_html(const TextTable& table, std::size_t first_number = 1) {
  std::string rows;
  for (std::size_t r = 1; r < table.size(); ++r) {
    rows += "<tr>";
    for (std::size_t c = 0; c < table[r].size(); ++c)
      rows += c == 0 ? cell(table[r][c], "th", first_number == 0 ? "n" : "") : number_cell(table[r][c]);
    rows += "</tr>\n";
  }
  return report::table(table.front(), rows, first_number);
}

std::string position_label(const analysis::FitRecord& record) {
  const bool angle = record.spec.quantity == scene_file::FitQuantity::reflectance;
  return (angle ? std::string("incidence") : record.spec.at.key) + " (" + record.spec.unit + ")";
}

PlotSeries simulated_series(const std::string& label, const analysis::FitRecord& record,
                            const analysis::ModelCurve& curve, double scale) {
  PlotSeries series;
  series.label = label;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    series.x.push_back(record.measured.points[i].x);
    series.y.push_back(scale * curve[i].value.value);
    series.error.push_back(scale * curve[i].value.error);
  }
  return series;
}

std::string curve_figure(const analysis::FitRecord& record) {
  PlotSeries measured;
  measured.label = "measured";
  measured.joined = false;
  for (const analysis::MeasuredCurve::Point& point : record.measured.points) {
    measured.x.push_back(point.x);
    measured.y.push_back(point.y.value);
    measured.error.push_back(record.fit.common_error.value_or(point.y.error));
  }
  PlotSeries start = simulated_series("start", record, record.fit.start_curve, record.fit.start_scale);
  start.dashed = true;
  start.marks = false;
  start.error.clear();
  PlotSeries fitted = simulated_series("fitted", record, record.fit.curve, record.fit.scale.value);
  fitted.marks = false;
  fitted.error.clear();
  Plot plot;
  plot.title = "Measured and simulated curves";
  plot.x_label = position_label(record);
  plot.y_label = record.spec.free_scale ? "measured units" : analysis::quantity_words(record.spec.quantity);
  plot.legend_above = true;
  plot.series = {measured, fitted, start};
  return "<figure><figcaption>Measured and simulated <span>one standard error" +
         std::string(record.spec.free_scale ? "; each simulated curve at the scale that fits it best" : "") +
         "</span></figcaption>\n" + chart(plot) + "</figure>\n";
}

std::string residual_figure(const analysis::FitRecord& record) {
  PlotSeries series;
  series.label = "residual";
  series.joined = false;
  for (std::size_t i = 0; i < record.fit.residual.size(); ++i) {
    series.x.push_back(record.measured.points[i].x);
    series.y.push_back(record.fit.residual[i]);
    series.error.push_back(1.0);
  }
  PlotSeries zero;
  zero.label = "none";
  zero.x = {series.x.front(), series.x.back()};
  zero.y = {0.0, 0.0};
  zero.marks = false;
  zero.dashed = true;
  Plot plot;
  plot.title = "Residuals";
  plot.x_label = position_label(record);
  plot.y_label = "(measured - fitted) / error";
  plot.y_from_zero = false;
  plot.legend_above = true;
  plot.height = 240.0;
  plot.series = {series, zero};
  return "<figure><figcaption>Residuals <span>in errors of measurement and simulation "
         "together</span></figcaption>\n" +
         chart(plot) + "</figure>\n";
}

/// Begins with a capital letter.
std::string sentence(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text + ".";
}

std::string paragraph(const std::string& text) { return "<p class=\"note\">" + escape_html(text) + "</p>\n"; }

TextTable step_table(const analysis::FitRecord& record) {
  TextTable table{{"step", "curves", "chi-square"}};
  for (const scene_file::FitParameterSpec& p : record.spec.parameters)
    table.front().push_back(p.unit.empty() ? p.label : p.label + " (" + p.unit + ")");
  if (record.spec.free_scale) table.front().emplace_back("scale");
  for (const analysis::CurveFitStep& step : record.fit.steps) {
    table.push_back({std::to_string(step.number) + (step.estimate ? "*" : ""),
                     std::to_string(step.evaluations), fixed(step.chi2, 2)});
    for (const double value : step.parameters) table.back().push_back(compact(value, 6));
    if (record.spec.free_scale) table.back().push_back(compact(step.scale, 6));
  }
  return table;
}

std::string keys_of(const analysis::FitRecord& record) {
  const auto key = [](const auto& parameter) { return parameter.path.key; };
  return "Fitted keys of the scene: " + core::list_of(record.spec.parameters, ", ", key) + ".";
}

}  // namespace

std::string fit_page(const analysis::FitRecord& record) {
  const analysis::CurveFit& fit = record.fit;
  std::string found = fit_table_html(fit_parameter_table(record));
  if (const TextTable correlation = fit_correlation_table(record); !correlation.empty())
    found += fit_table_html(correlation);
  found += paragraph(sentence(fit_end_text(record)) + " " + sentence(fit_goodness_text(record)));
  if (const std::string noise = fit_noise_text(record); !noise.empty()) found += paragraph(sentence(noise));
  if (record.omitted) found += omission_note(record.omitted, Figure::fraction);
  for (const std::string& warning : fit.warnings) found += paragraph("Warning: " + warning + ".");
  for (const std::string& note : record.notes) found += paragraph("Note: " + note + ".");
  std::string body = section("What was found", found);
  body += section(
      "Curves", curve_figure(record) + residual_figure(record) + fit_table_html(fit_curve_table(record), 0));
  body += section(
      "Steps of the search",
      fit_table_html(step_table(record), 0) +
          paragraph("* with other random numbers than the search's: the estimate. A search ends where "
                    "the noise of the simulation agrees with the measurement, so that its chi-square "
                    "is too small."));
  body += section(
      "How to read this",
      paragraph(keys_of(record)) +
          paragraph(
              "Errors are one standard error, from the Fisher information of the residuals. They hold the "
              "measurement's errors, the Monte Carlo errors of the fitted curve, and what the noise of the "
              "curve's slopes does to the position of the minimum; the part that is Monte Carlo noise is "
              "given "
              "beside them and falls with more photons. Two errors, above and "
              "below, are one of a value that is fitted by its inverse. They do not include errors of the "
              "scene itself.") +
          paragraph(fit_facts(record) + "."));
  const std::string title = record.title.empty() ? "Fit" : "Fit: " + record.title;
  return html_page(title,
                   fmt::format("{} of {} against {}", analysis::quantity_words(record.spec.quantity),
                               record.scene_file, record.spec.measurement.filename().string()),
                   kFitStyle, body);
}

}  // namespace scintray::report
