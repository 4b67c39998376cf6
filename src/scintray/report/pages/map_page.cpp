#include "scintray/report/pages/pages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scintray/report/pages/detail/html_parts.hpp"
#include "scintray/report/pages/page.hpp"
#include "scintray/report/plots/detail/height_image.hpp"
#include "scintray/report/plots/svg_plot.hpp"
#include "scintray/report/text/format.hpp"
#include "scintray/report/text/map_numbers.hpp"
#include "scintray/topography/prepare.hpp"

namespace scintray::report {

namespace {

constexpr const char* kMapStyle = R"css(
.grid { display: grid; grid-template-columns: repeat(auto-fit, minmax(20rem, 1fr)); gap: 1.5rem; }
img.heights { display: block; width: 100%; image-rendering: pixelated; }
.scale { display: flex; align-items: center; gap: .6rem; margin-top: .4rem; color: var(--soft);
  font-size: .85rem; font-variant-numeric: tabular-nums; white-space: nowrap; }
.scale i { flex: 1; height: .7rem; }
td.meaning { color: var(--soft); }
)css";

/// Range of heights that the colours span: all but one in a thousand at either end, so that a single spike
/// does not take the whole range.
std::pair<double, double> shown_range(const topography::HeightMap& map) {
  std::vector<double> heights;
  for (const double h : map.heights_um)
    if (!std::isnan(h)) heights.push_back(h);
  const auto cut = static_cast<std::ptrdiff_t>(heights.size() / 1000);
  std::nth_element(heights.begin(), heights.begin() + cut, heights.end());
  const double low = *(heights.begin() + cut);
  std::nth_element(heights.begin(), heights.end() - 1 - cut, heights.end());
  return {low, *(heights.end() - 1 - cut)};
}

std::string picture(const std::string& caption, const topography::HeightMap& map) {
  const auto [low, high] = shown_range(map);
  return fmt::format(
             "<figure>\n<figcaption>{} <span>{} x {} points, {:.4g} x {:.4g} um</span></figcaption>\n",
             caption, map.columns, map.rows, map.columns * map.pitch_x_um, map.rows * map.pitch_y_um) +
         height_image(map, low, high, "heights " + caption) + height_scale(low, high) + "</figure>\n";
}

/// Heights along the middle row or column; the line has a gap where points are missing.
PlotSeries profile(const std::string& label, const topography::HeightMap& map, bool along_x) {
  PlotSeries series;
  series.label = label;
  series.marks = false;
  const std::uint32_t n = along_x ? map.columns : map.rows;
  for (std::uint32_t k = 0; k < n; ++k) {
    series.x.push_back(k * (along_x ? map.pitch_x_um : map.pitch_y_um));
    series.y.push_back(along_x ? map.at(k, map.rows / 2) : map.at(map.columns / 2, k));
  }
  return series;
}

std::string profiles(const topography::HeightMap& before, const topography::HeightMap& after, bool along_x) {
  Plot plot;
  plot.title = std::string("Heights along ") + (along_x ? "x" : "y");
  plot.x_label = along_x ? "x (um), middle row" : "y (um), middle column";
  plot.y_label = "height (um)";
  plot.y_from_zero = false;
  plot.height = 280.0;
  for (const auto& [label, map] : {std::pair("before", &before), std::pair("after", &after)}) {
    PlotSeries series = profile(label, *map, along_x);
    if (std::any_of(series.y.begin(), series.y.end(), [](double y) { return !std::isnan(y); }))
      plot.series.push_back(std::move(series));
  }
  return plot.series.empty() ? "" : "<figure>" + chart(plot) + "</figure>\n";
}

std::string number_table(const topography::HeightMap& before, const topography::HeightMap& after) {
  const std::vector<MapNumber> old_numbers = map_numbers(before), new_numbers = map_numbers(after);
  std::string table = scroll_area("numbers of the map") +
                      "<table>\n<thead><tr><th></th><th class=\"n\">before</th><th "
                      "class=\"n\">after</th>"
                      "<th></th></tr></thead>\n<tbody>\n";
  for (std::size_t k = 0; k < new_numbers.size(); ++k)
    table += fmt::format(
        "<tr><th>{}</th><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"meaning\">{}</td></tr>\n",
        escape_html(new_numbers[k].name), escape_html(old_numbers[k].value),
        escape_html(new_numbers[k].value), escape_html(new_numbers[k].meaning));
  return table + "</tbody>\n</table></div>\n";
}

}  // namespace

std::string map_page(const std::string& title, const topography::HeightMap& before,
                     const topography::HeightMap& after) {
  topography::HeightMap centred = before;
  topography::subtract_mean(centred);
  std::string page;
  page += "<h2>Heights</h2>\n<div class=\"grid\">\n" + picture("before, less the mean", centred) +
          picture("after", after) + "</div>\n";
  page += "<h2>Profiles</h2>\n" + profiles(centred, after, true) + profiles(centred, after, false);
  page += "<h2>Numbers</h2>\n" + number_table(before, after);
  page += "<h2>Steps</h2>\n<ol>\n";
  for (const std::string& step : after.steps) page += "<li>" + escape_html(step) + "</li>\n";
  return html_page(title, "Height map before and after preparation", kMapStyle, page + "</ol>\n");
}

void write_map_page(const std::filesystem::path& path, const std::string& title,
                    const topography::HeightMap& before, const topography::HeightMap& after) {
  write_page(path, map_page(title, before, after));
}

}  // namespace scintray::report
