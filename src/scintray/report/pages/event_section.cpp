#include "scintray/report/pages/event_section.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/report/pages/detail/html_parts.hpp"
#include "scintray/report/pages/page.hpp"
#include "scintray/report/plots/detail/event_plots.hpp"
#include "scintray/report/text/detail/event_text.hpp"
#include "scintray/report/text/format.hpp"
#include "scintray/report/text/omissions.hpp"

namespace scintray::report {

namespace {

constexpr std::size_t kPointsShown = 4, kCurvesTogether = 7, kFewParts = 16;
constexpr const char* kEventStyle =
    ".grid { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(24rem, 100%), 1fr)); gap: "
    "1.25rem; }\n"
    ".grid figure { max-width: 36rem; } details { margin-top: .75rem; } summary { cursor: pointer; }\n"
    ".omitted { color: var(--soft); font-size: .88rem; margin: .25rem 0; }\n";

std::string event_figure(const std::string& drawing, const std::string& label, const std::string& title,
                         const std::string& text) {
  return "<figure>" + drawing + "<figcaption>" + escape_html(label) + ": " + escape_html(title) + ". <span>" +
         escape_html(text) + "</span></figcaption></figure>\n";
}

/// A text about a figure, and the effects that the figure does not include.
std::string with_omissions(const std::string& text, const PointAnalysis& point, Figure figure) {
  return text + ". " + omission_sentence(point.omitted, figure);
}

std::string difference_figure(const analysis::Spread& differences, const PointAnalysis& point,
                              const std::string& title) {
  const bool drawn = !differences.fitted.counts.empty();
  return event_figure(drawn ? chart(difference_plot(differences, "time difference")) : "", point.label, title,
                      with_omissions(spread_text(differences), point, Figure::timing));
}

std::string layers_table(const analysis::Confusion& confusion) {
  std::vector<std::string> head{"true layer"};
  std::string rows;
  for (std::size_t assigned = 0; assigned < confusion.classes; ++assigned)
    head.push_back("assigned " + std::to_string(assigned));
  for (std::size_t truth = 0; truth < confusion.classes; ++truth) {
    rows += "<tr>" + cell(std::to_string(truth), "th");
    for (std::size_t assigned = 0; assigned < confusion.classes; ++assigned)
      rows += number_cell(grouped(confusion.at(truth, assigned)));
    rows += "</tr>\n";
  }
  return table(head, rows);
}

std::string figures(const PointAnalysis& point) {
  const analysis::EventAnalysis& analysis = point.analysis;
  std::string out;
  if (analysis.spectrum)
    out += event_figure(chart(spectrum_plot(analysis)), point.label, "energy spectrum",
                        with_omissions(peak_text(analysis), point, Figure::resolution));
  if (analysis.light_against_depth)
    out += event_figure(chart(depth_plot(*analysis.light_against_depth)), point.label, "light against depth",
                        depth_text(*analysis.light_against_depth));
  if (analysis.flood) {
    GridMap map = flood_picture(analysis);
    map.outlines = point.crystals;
    out += event_figure(
        grid_map(map), point.label, "flood map",
        flood_text(*analysis.flood) + "; lines are the borders of the regions assigned to peaks" +
            (map.outlines.empty() ? "" : ", dashed ones the crystals where they stand") +
            (analysis.flood->crystals.empty() ? "" : ", numbers those of the table of parts"));
  } else if (const std::string reason = analysis::reason_left_out(analysis, "flood map"); !reason.empty())
    out += event_figure("", point.label, "no flood map", reason);
  if (analysis.doi && !analysis.doi->slices.empty())
    out += event_figure(chart(doi_plot(*analysis.doi)), point.label, "depth of interaction",
                        doi_text(*analysis.doi));
  if (analysis.pair_difference_ns)
    out += difference_figure(*analysis.pair_difference_ns, point, "coincidence of two such detectors");
  if (analysis.first_photon_difference_ns)
    out += difference_figure(*analysis.first_photon_difference_ns, point, "coincidence by the first photon");
  if (analysis.end_difference_ns)
    out += difference_figure(*analysis.end_difference_ns, point, "one end minus the other");
  if (analysis.timing_against_depth)
    out += event_figure(chart(timing_depth_plot(*analysis.timing_against_depth)), point.label,
                        "timing against depth", timing_depth_text(*analysis.timing_against_depth));
  if (analysis.orders)
    out += event_figure(
        chart(order_plot(*analysis.orders, analysis.orders_bound)), point.label,
        "coincidence of two such detectors by order of photons",
        with_omissions(order_text(*analysis.orders, analysis.orders_bound), point, Figure::timing));
  if (!analysis.orders_against_depth.empty())
    out += event_figure(chart(order_depth_plot(analysis)), point.label,
                        "coincidence by order of photons against depth", order_depth_text(analysis));
  if (analysis.layers_by_ratio)
    out += event_figure(layers_table(analysis.layers_by_ratio->confusion), point.label,
                        "layers by the ratio of the ends", layers_text(analysis.layers_by_ratio->confusion));
  if (analysis.layers_by_flood)
    out += event_figure(layers_table(*analysis.layers_by_flood), point.label, "layers by the flood map",
                        layers_text(*analysis.layers_by_flood));
  return out;
}

/// A number, or the reason why there is none.
std::string number_or_reason(const PointAnalysis& point, const std::string& number,
                             const std::string& analysis) {
  if (!number.empty()) return number_cell(number);
  const std::string reason = analysis::reason_left_out(point.analysis, analysis);
  return cell("none: " + (reason.empty() ? "not available" : reason), "td", "why");
}

std::string numbers_row(const PointAnalysis& point) {
  const analysis::EventAnalysis& analysis = point.analysis;
  const bool peak = analysis.peak.has_numbers();
  const std::string no_peak = cell("none: " + analysis.peak.reason, "td", "why");
  const std::string status = analysis::status_name(analysis.peak.status);
  return "<tr>" + cell(point.label, "th") + number_cell(grouped(analysis.pulses)) +
         number_cell(analysis.pulses > 0 ? with_error(analysis.mean_light) : "none: no pulse") +
         (peak ? number_cell(with_error(analysis.peak.fit.position)) : no_peak) +
         (peak ? number_cell(percent_with_error(analysis.peak.fit.relative_fwhm)) : no_peak) + cell(status) +
         number_or_reason(point, analysis.doi ? with_error(analysis.doi->residual.quantile_fwhm) : "",
                          "depth of interaction") +
         number_or_reason(point, analysis.flood ? std::to_string(analysis.flood->peaks.size()) : "",
                          "flood map") +
         number_or_reason(point,
                          analysis.pair_difference_ns
                              ? picoseconds(analysis::quoted_fwhm(*analysis.pair_difference_ns))
                              : "",
                          "timing") +
         "</tr>\n";
}

std::string numbers_table(const std::vector<PointAnalysis>& points) {
  std::string rows;
  for (const PointAnalysis& point : points) rows += numbers_row(point);
  return table({"point", "pulses", "mean light", "photopeak", "resolution (FWHM)", "status", "DOI FWHM (mm)",
                "flood peaks", "CTR (FWHM)"},
               rows);
}

/// True for points whose distances in depth exceed twice the spread of depths within any of them.
bool are_apart(std::vector<double> depths_mm, double spread_mm) {
  std::sort(depths_mm.begin(), depths_mm.end());
  for (std::size_t i = 1; i < depths_mm.size(); ++i)
    if (depths_mm[i] - depths_mm[i - 1] <= 2.0 * spread_mm) return false;
  return depths_mm.size() > 1;
}

/// Points of a sweep over depth, all by photopeak or all by mean, as one curve.
std::string curve_over_points(const std::vector<PointAnalysis>& points) {
  std::vector<analysis::DepthPoint> curve_points;
  std::vector<double> depths;
  double spread = 0.0;
  for (const PointAnalysis& point : points) {
    const auto depth = analysis::depth_point(point.analysis);
    if (!depth || !(depth->value.error > 0.0)) return "";
    curve_points.push_back(*depth);
    depths.push_back(depth->depth_mm);
    spread =
        std::max(spread, point.analysis.mean_depth_mm->error * std::sqrt(static_cast<double>(depth->count)));
  }
  const bool alike = std::all_of(
      curve_points.begin(), curve_points.end(),
      [&](const analysis::DepthPoint& depth) { return depth.from_peak == curve_points.front().from_peak; });
  if (!alike || !are_apart(depths, spread)) return "";
  const analysis::DepthCurve curve =
      analysis::depth_curve(curve_points, *std::min_element(depths.begin(), depths.end()));
  return event_figure(chart(depth_plot(curve)), "all points", "light against depth", depth_text(curve));
}

/// Timing by order of photons of all points, where several have it and few enough to be distinguishable.
std::string orders_over_points(const std::vector<PointAnalysis>& points) {
  std::vector<std::pair<std::string, analysis::OrderAnalysis>> with_orders;
  for (const PointAnalysis& point : points)
    if (point.analysis.orders) with_orders.emplace_back(point.label, *point.analysis.orders);
  if (with_orders.size() < 2 || with_orders.size() > kCurvesTogether) return "";
  std::string text;
  for (const auto& [label, orders] : with_orders)
    text += (text.empty() ? "" : "; ") + label +
            ": best n = " + std::to_string(orders.single[orders.best_single].n) + ", " +
            picoseconds(orders.single[orders.best_single].ctr_fwhm_ns);
  return event_figure(chart(orders_plot(with_orders)), "all points",
                      "coincidence of two such detectors by the n-th photon", text);
}

/// Light and spectrum of each part of a point with several, numbered as on its flood map.
std::string parts_table(const PointAnalysis& point, const PartNames& names) {
  const analysis::EventAnalysis& analysis = point.analysis;
  if (analysis.parts.size() < 2) return "";
  std::vector<std::uint64_t> assigned(analysis.parts.size() + 1, 0);
  if (analysis.flood && !analysis.flood->crystals.empty())
    for (const analysis::FloodPeak& peak : analysis.flood->peaks)
      assigned.at(part_number(analysis, analysis.flood->crystals[peak.owner]) - 1) += peak.events;
  std::string rows;
  for (std::size_t i = 0; i < analysis.parts.size(); ++i) {
    const analysis::PartLight& part = analysis.parts[i];
    const bool peak = part.peak.has_numbers();
    const std::string no_peak =
        "<td class=\"why\" colspan=\"2\">" + escape_html("none: " + part.peak.reason) + "</td>";
    const std::string name =
        names.contains(part.part) ? names[part.part] : "part " + std::to_string(part.part.index());
    rows += "<tr>" + number_cell(std::to_string(i + 1)) + cell(name, "th") +
            number_cell(grouped(part.pulses)) +
            number_cell(part.pulses > 1 ? with_error(part.mean_light) : compact(part.mean_light.value)) +
            (peak ? number_cell(with_error(part.peak.fit.position)) +
                        number_cell(percent_with_error(part.peak.fit.relative_fwhm))
                  : no_peak) +
            (analysis.flood ? number_cell(grouped(assigned[i])) : "") + "<td>" + small_spectrum(part) +
            "</td></tr>\n";
  }
  std::vector<std::string> head{"number", "part", "pulses", "mean light", "photopeak", "resolution (FWHM)"};
  if (analysis.flood) head.emplace_back("assigned by the flood map");
  head.emplace_back("spectrum");
  return "<details" + std::string(analysis.parts.size() <= kFewParts ? " open=\"open\"" : "") + "><summary>" +
         escape_html(point.label) + ": light of each of the " + std::to_string(analysis.parts.size()) +
         " parts, by the largest deposit of an event</summary>\n" + table(head, rows, 1, false) +
         "</details>\n";
}

/// Beside the table of numbers: the effects that its resolutions and CTRs do not include.
std::string omissions_of(const std::vector<PointAnalysis>& points) {
  std::vector<std::optional<std::vector<tally::OmittedEffect>>> omitted;
  bool peaks = false, times = false;
  for (const PointAnalysis& point : points) {
    omitted.push_back(point.omitted);
    peaks = peaks || point.analysis.peak.has_numbers();
    times = times || point.analysis.pair_difference_ns || point.analysis.orders;
  }
  const auto all = omitted_anywhere(omitted);
  return (peaks ? omission_note(all, Figure::resolution) : "") +
         (times ? omission_note(all, Figure::timing) : "");
}

std::string left_out_list(const std::vector<PointAnalysis>& points) {
  std::string items;
  for (const PointAnalysis& point : points)
    for (const std::string& line : point.analysis.left_out)
      items += "<li>" + escape_html(point.label + ": " + line) + "</li>\n";
  return items.empty() ? ""
                       : "<details><summary>What was left out</summary><ul>\n" + items + "</ul></details>\n";
}

}  // namespace

std::string event_section(const std::vector<PointAnalysis>& points, const PartNames& parts) {
  const bool any = std::any_of(points.begin(), points.end(),
                               [](const PointAnalysis& point) { return point.analysis.events > 0; });
  if (!any) return "";
  std::string first = curve_over_points(points) + orders_over_points(points), others;
  for (std::size_t i = 0; i < points.size(); ++i) (i < kPointsShown ? first : others) += figures(points[i]);
  std::string tables;
  for (std::size_t i = 0; i < std::min(points.size(), kPointsShown); ++i)
    tables += parts_table(points[i], parts);
  std::string body =
      numbers_table(points) + omissions_of(points) + "<div class=\"grid\">\n" + first + "</div>\n" + tables;
  if (!others.empty())
    body += "<details><summary>The other points</summary>\n<div class=\"grid\">\n" + others +
            "</div></details>\n";
  return section("Events", body + left_out_list(points));
}

std::string event_page(const std::string& title, const std::string& under,
                       const std::vector<PointAnalysis>& points, const PartNames& parts) {
  return html_page(title, under, kEventStyle + grid_map_style(), event_section(points, parts));
}

std::string event_lines(const analysis::EventAnalysis& analysis,
                        const std::optional<std::vector<tally::OmittedEffect>>& omitted) {
  if (analysis.events == 0) return "";
  std::string lines = "pulses: " + grouped(analysis.pulses) + " of " + grouped(analysis.events) + " events";
  if (analysis.pulses > 0)
    lines += ", mean light " + with_error(analysis.mean_light) + " " + light_unit(analysis);
  lines += "\nspectrum: " + peak_text(analysis) + "\n";
  if (analysis.peak.has_numbers()) lines += omission_sentence(omitted, Figure::resolution) + "\n";
  if (analysis.light_against_depth)
    lines += "light against depth: " + depth_text(*analysis.light_against_depth) + "\n";
  if (analysis.flood || analysis.doi || analysis.pair_difference_ns)
    lines += "the following from " + analysis.selection + " (" + grouped(analysis.selected) + ")\n";
  if (analysis.flood) lines += "flood map: " + flood_text(*analysis.flood) + "\n";
  if (analysis.doi) lines += "depth of interaction: " + doi_text(*analysis.doi) + "\n";
  if (analysis.layers_by_ratio)
    lines += "layers by the ratio of the ends: " + layers_text(analysis.layers_by_ratio->confusion) + "\n";
  if (analysis.layers_by_flood)
    lines += "layers by the flood map: " + layers_text(*analysis.layers_by_flood) + "\n";
  if (analysis.pair_difference_ns)
    lines += "coincidence of two such detectors: " + spread_text(*analysis.pair_difference_ns) + "\n";
  if (analysis.first_photon_difference_ns)
    lines += "coincidence by the first photon: " + spread_text(*analysis.first_photon_difference_ns) + "\n";
  if (analysis.end_difference_ns)
    lines += "one end minus the other: " + spread_text(*analysis.end_difference_ns) + "\n";
  if (analysis.timing_against_depth)
    lines += "timing against depth: " + timing_depth_text(*analysis.timing_against_depth) + "\n";
  if (analysis.orders) {
    lines += "timing by order of photons: " + order_text(*analysis.orders, analysis.orders_bound) + "\n";
    lines += "CTR by the n-th photon: " + order_list(*analysis.orders, analysis.orders_bound) + "\n";
  }
  if (!analysis.orders_against_depth.empty())
    lines += "timing by order of photons against depth: " + order_depth_text(analysis) + "\n";
  if (analysis.pair_difference_ns || analysis.orders)
    lines += omission_sentence(omitted, Figure::timing) + "\n";
  for (const std::string& line : analysis.left_out) lines += "left out: " + line + "\n";
  return lines;
}

}  // namespace scintray::report
