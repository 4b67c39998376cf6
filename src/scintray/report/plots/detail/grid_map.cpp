#include "scintray/report/plots/detail/grid_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "scintray/core/vec.hpp"
#include "scintray/report/plots/png_image.hpp"
#include "scintray/report/plots/svg_plot.hpp"
#include "scintray/report/text/format.hpp"

namespace scintray::report {

namespace {

/// Drawing: longest side of the grid, and margins for ticks and labels.
constexpr double kSide = 340.0, kLeft = 64.0, kBelow = 46.0, kMargin = 12.0;
constexpr double kMostStretch = 4.0;
constexpr std::uint32_t kPolarPixels = 320;

void check(const GridMap& map) {
  if (map.values.size() != map.rows * map.columns || map.values.empty())
    throw std::invalid_argument("a map of " + std::to_string(map.values.size()) + " values for " +
                                std::to_string(map.rows) + " x " + std::to_string(map.columns) + " cells");
}

double largest(const GridMap& map) {
  return std::max(*std::max_element(map.values.begin(), map.values.end()), 1e-300);
}

/// Place of a value on the scale of colours, 0 to 1.
double shade(const GridMap& map, double value, double most) {
  return map.logarithmic ? std::log1p(value / map.unit) / std::log1p(most / map.unit) : value / most;
}

std::string scale(const GridMap& map) {
  const double most = largest(map);
  std::string gradient = "<i style=\"background:" + viridis_gradient() + "\"></i>";
  std::string unit = map.value_label;
  if (map.logarithmic) {
    const double middle = map.unit * std::expm1(0.5 * std::log1p(most / map.unit));
    gradient =
        "<span class=\"shades\">" + gradient + "<span>" + escape_html(compact(middle, 2)) + "</span></span>";
    unit += ", logarithmic";
  }
  return "<div class=\"scale\"><span>0</span>" + gradient + "<span>" +
         escape_html(compact(most, 3) + " " + unit) + "</span></div>\n";
}

/// The lines over the map as one path.
std::string line_path(const GridMap& map, double width, double height) {
  if (map.lines.empty()) return "";
  std::string path;
  for (const auto& [x1, y1, x2, y2] : map.lines) {
    const auto right = [&](double x) { return kLeft + width * (x - map.x_low) / (map.x_high - map.x_low); };
    const auto down = [&](double y) {
      return kMargin + height * (map.y_high - y) / (map.y_high - map.y_low);
    };
    path += fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", right(x1), down(y1), right(x2), down(y2));
  }
  return "<path class=\"border\" d=\"" + path + "\"/>\n";
}

/// The rectangles over the map, as far as they lie on it, as one path.
std::string outline_path(const GridMap& map, double width, double height) {
  std::string path;
  for (const auto& [x1, y1, x2, y2] : map.outlines) {
    if (x2 <= map.x_low || x1 >= map.x_high || y2 <= map.y_low || y1 >= map.y_high) continue;
    const auto right = [&](double x) {
      return kLeft + width * (std::clamp(x, map.x_low, map.x_high) - map.x_low) / (map.x_high - map.x_low);
    };
    const auto down = [&](double y) {
      return kMargin +
             height * (map.y_high - std::clamp(y, map.y_low, map.y_high)) / (map.y_high - map.y_low);
    };
    path += fmt::format("M{:.1f} {:.1f}H{:.1f}V{:.1f}H{:.1f}Z", right(x1), down(y1), right(x2), down(y2),
                        right(x1));
  }
  return path.empty() ? "" : "<path class=\"outline\" d=\"" + path + "\"/>\n";
}

/// Texts at places of the map, as large as their distance allows; none when they would be too small to read.
std::string mark_texts(const GridMap& map, double width, double height) {
  constexpr double kLargest = 13.0, kSmallest = 5.5;
  if (map.marks.empty()) return "";
  const double apart = std::sqrt(width * height / static_cast<double>(map.marks.size()));
  const double size = std::min(kLargest, 0.45 * apart);
  if (size < kSmallest) return "";
  std::string out;
  for (const GridMap::Mark& mark : map.marks)
    out += fmt::format(
        "<text class=\"mark-text\" style=\"font-size:{:.1f}px\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", size,
        kLeft + width * (mark.x - map.x_low) / (map.x_high - map.x_low),
        kMargin + height * (map.y_high - mark.y) / (map.y_high - map.y_low) + 0.35 * size,
        escape_html(mark.text));
  return out;
}

std::string json_texts(const std::vector<std::string>& texts) {
  std::string json = "[";
  for (const std::string& text : texts) json += (json.size() > 1 ? "," : "") + json_text(text);
  return json + "]";
}

/// The data of both pictures, without the closing brace.
std::string common_json(const GridMap& map) {
  return "{\"title\":" + json_text(map.alternative) + ",\"value\":" + json_text(map.value_label) +
         fmt::format(",\"rows\":{},\"columns\":{},\"log\":{},\"unit\":{:.6g},\"values\":", map.rows,
                     map.columns, map.logarithmic, map.unit) +
         json_numbers(map.values, 6);
}

std::string image(const std::string& data, double x, double y, double width, double height) {
  return fmt::format(
      "<image x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" preserveAspectRatio=\"none\" "
      "style=\"image-rendering:pixelated\" href=\"{}\"/>\n",
      x, y, width, height, data);
}

std::string opening(double width, double height, const std::string& alternative) {
  return fmt::format(
      "<svg class=\"grid-map\" viewBox=\"0 0 {0:.0f} {1:.0f}\" style=\"max-width:{0:.0f}px\" role=\"img\" "
      "aria-label=\"{2}\">\n",
      width, height, escape_html(alternative));
}

}  // namespace

std::string grid_map(const GridMap& map) {
  check(map);
  const double wide = map.x_high - map.x_low, high = map.y_high - map.y_low;
  const double ratio = wide > 0.0 && high > 0.0 ? wide / high : 1.0;
  const bool keeps = ratio < kMostStretch && ratio > 1.0 / kMostStretch;
  const double width = keeps && ratio < 1.0 ? kSide * ratio : kSide;
  const double height = keeps && ratio > 1.0 ? kSide / ratio : kSide;

  std::vector<Colour> pixels;
  const double most = largest(map);
  for (std::size_t row = map.rows; row-- > 0;)
    for (std::size_t column = 0; column < map.columns; ++column)
      pixels.push_back(viridis(shade(map, map.values[row * map.columns + column], most)));
  const std::string data =
      png_data(pixels, static_cast<std::uint32_t>(map.columns), static_cast<std::uint32_t>(map.rows));

  std::string out = opening(kLeft + width + kMargin, kMargin + height + kBelow, map.alternative);
  out += "<g class=\"cells\">\n" + image(data, kLeft, kMargin, width, height) +
         line_path(map, width, height) + outline_path(map, width, height) + mark_texts(map, width, height) +
         "</g>\n<g class=\"axes\">\n";
  for (const double tick : nice_ticks(map.x_low, map.x_high, 5)) {
    if (tick < map.x_low || tick > map.x_high) continue;
    out += fmt::format("<text class=\"tick\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n",
                       kLeft + width * (tick - map.x_low) / wide, kMargin + height + 16.0, compact(tick));
  }
  for (const double tick : nice_ticks(map.y_low, map.y_high, 5)) {
    if (tick < map.y_low || tick > map.y_high) continue;
    out += fmt::format("<text class=\"tick\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n",
                       kLeft - 6.0, kMargin + height * (map.y_high - tick) / high + 4.0, compact(tick));
  }
  out += "</g>\n";
  out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n",
                     kLeft + 0.5 * width, kMargin + height + 36.0, escape_html(map.x_label));
  out += fmt::format(
      "<text transform=\"translate(14 {:.1f}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n</svg>\n",
      kMargin + 0.5 * height, escape_html(map.y_label));
  const std::string json = common_json(map) + ",\"x\":" + json_numbers({map.x_low, map.x_high}, 12) +
                           ",\"y\":" + json_numbers({map.y_low, map.y_high}, 12) +
                           ",\"area\":" + json_numbers({kLeft, kMargin, kLeft + width, kMargin + height}) +
                           ",\"labels\":[" + json_text(map.x_label) + "," + json_text(map.y_label) +
                           "],\"names\":[" + json_texts(map.x_names) + "," + json_texts(map.y_names) + "]}";
  return chart_box("grid", map.alternative, out + scale(map), json);
}

std::string polar_map(const GridMap& map) {
  check(map);
  const double most = largest(map);
  constexpr double kHalf = 0.5 * kPolarPixels, kMiddle = kMargin + 0.5 * kSide;
  std::vector<Colour> pixels;
  for (std::uint32_t y = 0; y < kPolarPixels; ++y)
    for (std::uint32_t x = 0; x < kPolarPixels; ++x) {
      const double right = (x + 0.5 - kHalf) / kHalf, up = (kHalf - y - 0.5) / kHalf;
      const double polar = 0.5 * core::kPi * std::hypot(right, up);
      if (polar >= 0.5 * core::kPi) {
        pixels.push_back(viridis(0.0));
        continue;
      }
      const double sine = std::sin(polar), azimuth = std::atan2(up, right);
      const auto row =
          std::min(map.rows - 1, static_cast<std::size_t>(sine * sine * static_cast<double>(map.rows)));
      const auto column = std::min(
          map.columns - 1,
          static_cast<std::size_t>((azimuth + core::kPi) / core::kTwoPi * static_cast<double>(map.columns)));
      pixels.push_back(viridis(shade(map, map.values[row * map.columns + column], most)));
    }
  std::string out = opening(kSide + 2.0 * kMargin, kSide + 2.0 * kMargin, map.alternative);
  out += image(png_data(pixels, kPolarPixels, kPolarPixels), kMargin, kMargin, kSide, kSide);
  out += fmt::format(
      "<path class=\"beyond\" fill-rule=\"evenodd\" d=\"M0 0H{0}V{0}H0Z M{1} {2}a{3} {3} 0 1 0 {4} 0a{3} {3} "
      "0 1 0 "
      "-{4} 0Z\"/>\n",
      kSide + 2.0 * kMargin, kMargin, kMiddle, 0.5 * kSide, kSide);
  for (const int degrees : {30, 60, 90})
    out += fmt::format("<circle class=\"ring\" cx=\"{0}\" cy=\"{0}\" r=\"{1:.1f}\"/>\n", kMiddle,
                       0.5 * kSide * degrees / 90.0);
  std::vector<double> edges, cells(map.rows, static_cast<double>(map.columns));
  for (std::size_t row = 0; row <= map.rows; ++row)
    edges.push_back(std::asin(std::sqrt(static_cast<double>(row) / static_cast<double>(map.rows))) /
                    core::kDegree);
  const std::string json =
      common_json(map) + polar_json({edges, cells, -180.0, kMiddle, 0.5 * kSide, kPolarPixels}) + "}";
  return chart_box("polar", map.alternative, out + "</svg>\n" + scale(map), json);
}

std::string polar_json(const PolarCells& cells) {
  return ",\"edges\":" + json_numbers(cells.edges_deg) + ",\"cells\":" + json_numbers(cells.count) +
         fmt::format(",\"start\":{},\"middle\":{:g},\"radius\":{:g},\"pixels\":{}",
                     cells.start_deg ? compact(*cells.start_deg) : "null", cells.middle, cells.radius,
                     cells.pixels);
}

std::string grid_map_style() {
  return ".grid-map { width: 100%; height: auto; display: block; } .grid-map text { font-size: 13px; fill: "
         "var(--ink); }\n"
         ".grid-map .tick { font-size: 12px; fill: var(--soft); } .grid-map .beyond { fill: var(--paper); }\n"
         ".grid-map .ring { fill: none; stroke: #fff; stroke-opacity: .5; }\n"
         ".grid-map .border { fill: none; stroke: #fff; stroke-opacity: .75; stroke-width: 1; }\n"
         ".grid-map .outline { fill: none; stroke: #ff9c73; stroke-opacity: .8; stroke-width: 1; "
         "stroke-dasharray: 3 2; }\n"
         ".grid-map .mark-text { fill: #fff; stroke: #000; stroke-width: .18em; paint-order: stroke; "
         "text-anchor: middle; font-weight: 600; }\n"
         ".scale { display: flex; gap: .5rem; align-items: center; font-size: .85rem; color: var(--soft); }\n"
         ".scale i { width: 10rem; height: .7rem; border-radius: 2px; }\n"
         // The scale of goniometers on the same page is laid out otherwise.
         ".grid-map + .scale { flex-wrap: wrap; white-space: normal; margin: 0; }\n"
         ".scale .shades { display: flex; flex-direction: column; align-items: center; }\n"
         ".scale .shades i { flex: none; }\n";
}

}  // namespace scintray::report
