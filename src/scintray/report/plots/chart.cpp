#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "scintray/report/plots/svg_plot.hpp"
#include "scintray/report/text/format.hpp"

namespace scintray::report {

namespace {

const char* json_bool(bool value) { return value ? "true" : "false"; }

std::string series_json(const PlotSeries& series) {
  return "{\"n\":" + json_text(series.label) + ",\"x\":" + json_numbers(series.x) +
         ",\"y\":" + json_numbers(series.y) + ",\"e\":" + json_numbers(series.error) +
         fmt::format(",\"steps\":{},\"marks\":{},\"joined\":{},\"dashed\":{}}}", series.steps,
                     series.marks && !series.steps, series.steps || series.joined, series.dashed);
}

}  // namespace

std::string json_numbers(const std::vector<double>& numbers, int digits) {
  std::string json = "[";
  for (const double number : numbers) {
    if (json.size() > 1) json += ',';
    json += std::isfinite(number) ? compact(number, digits) : "null";
  }
  return json + "]";
}

std::string json_text(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string chart_box(const std::string& kind, const std::string& name, const std::string& drawing,
                      const std::string& json) {
  std::string data;
  for (const char c : json) {  // nothing in it ends the script element (HTML, section 4.12.1.3)
    if (c == '<')
      data += "\\u003c";
    else
      data += c;
  }
  return "<div class=\"chart\" data-kind=\"" + kind +
         "\"><div class=\"scroll canvas\" tabindex=\"0\" role=\"group\" aria-label=\"" + escape_html(name) +
         "\">" + drawing + "</div>\n<script type=\"application/json\">" + data + "</script></div>\n";
}

std::string chart(const Plot& plot) {
  const PlotFrame f = plot_frame(plot);
  std::string json = "{\"title\":" + json_text(plot.title) + ",\"x\":" + json_text(plot.x_label) +
                     ",\"y\":" + json_text(plot.y_label) +
                     ",\"area\":" + json_numbers({f.left, f.top, f.right, f.bottom}) +
                     ",\"xr\":" + json_numbers({f.x_low, f.x_high}, 12) +
                     ",\"yr\":" + json_numbers({f.y_low, f.y_high}, 12) +
                     ",\"log\":" + json_bool(plot.log_y) + ",\"zero\":" + json_bool(plot.y_from_zero);
  if (plot.top) json += ",\"top\":" + compact(plot.top->per_unit, 12);
  json += ",\"series\":[";
  for (std::size_t i = 0; i < plot.series.size(); ++i)
    json += (i > 0 ? "," : "") + series_json(plot.series[i]);
  return chart_box("plot", plot.title, svg_plot(plot), json + "]}");
}

std::string svg_file(const Plot& plot) {
  std::string drawing = svg_plot(plot);
  const std::string opening = "<svg class=\"plot\"";
  drawing.replace(0, opening.size(), "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"plot\"");
  const std::string colours =
      ":root { --paper:#ffffff; --ink:#1b1f24; --soft:#5c6670; --rule:#e3e7eb; }\n"
      "@media screen and (prefers-color-scheme: dark) {\n"
      ":root { --paper:#14181c; --ink:#e6e9ec; --soft:#9aa5af; --rule:#2c333a; } }\n";
  const std::size_t inside = drawing.find(">\n") + 2;
  drawing.insert(inside,
                 "<style>" + colours + svg_plot_style() + "svg.plot { background: var(--paper); }</style>\n");
  return drawing;
}

std::string svg_plot_style() {
  return R"css(
:root { --c0:#0072b2; --c1:#d55e00; --c2:#009e73; --c3:#b35a8c; --c4:#b8860b; --c5:#3a9bd6; --c6:#555555; }
@media screen and (prefers-color-scheme: dark) {
:root { --c0:#56b4e9; --c1:#f0894a; --c2:#2fc79c; --c3:#e096bf; --c4:#e6b822; --c5:#9ad0f2; --c6:#bbbbbb; } }
/* Colours of names: 4.5 to 1 against the page. */
:root { --t0:#0072b2; --t1:#a84a00; --t2:#00704f; --t3:#9a4476; --t4:#7d5b00; --t5:#1c6ea4; --t6:#555555; }
@media screen and (prefers-color-scheme: dark) {
:root { --t0:#56b4e9; --t1:#f0894a; --t2:#2fc79c; --t3:#e096bf; --t4:#e6b822; --t5:#9ad0f2; --t6:#bbbbbb; } }
.c0 { --t: var(--t0); } .c1 { --t: var(--t1); } .c2 { --t: var(--t2); } .c3 { --t: var(--t3); }
.c4 { --t: var(--t4); } .c5 { --t: var(--t5); } .c6 { --t: var(--t6); }
.c0 { --c: var(--c0); } .c1 { --c: var(--c1); } .c2 { --c: var(--c2); } .c3 { --c: var(--c3); }
.c4 { --c: var(--c4); } .c5 { --c: var(--c5); } .c6 { --c: var(--c6); }
svg.plot { width: 100%; height: auto; display: block; font: 14px system-ui, sans-serif; }
svg.plot .grid { stroke: var(--rule); stroke-width: 1; }
svg.plot .axis { stroke: var(--soft); stroke-width: 1.2; }
svg.plot text { fill: var(--ink); } svg.plot text.tick { fill: var(--soft); font-variant-numeric: tabular-nums; }
svg.plot .middle { text-anchor: middle; } svg.plot .end { text-anchor: end; }
svg.plot text.name { fill: var(--t); font-weight: 600; }
svg.plot .curve { fill: none; stroke: var(--c); stroke-width: 2; stroke-linejoin: round; }
svg.plot .dashed { stroke-dasharray: 7 5; }
svg.plot .mark { fill: var(--c); } svg.plot .error { stroke: var(--c); stroke-width: 1.4; }
)css";
}

}  // namespace scintray::report
