#include "scintray/report/plots/detail/hemisphere_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scintray/report/plots/detail/grid_map.hpp"
#include "scintray/report/plots/png_image.hpp"
#include "scintray/report/plots/svg_plot.hpp"
#include "scintray/report/text/format.hpp"

namespace scintray::report {

namespace {

constexpr std::uint32_t kPixels = 360;
constexpr double kDecades = 3.0;
/// Of the drawing: half its side, and the radius of the horizon.
constexpr double kMiddle = 200.0, kRadius = 180.0;

/// Density in every cell over the largest one, as a share of the colours.
std::vector<double> shares(const std::vector<double>& density, double largest) {
  std::vector<double> share;
  for (const double value : density)
    share.push_back(value > 0.0 ? 1.0 + std::log10(value / largest) / kDecades : 0.0);
  return share;
}

std::string picture(const std::vector<double>& share) {
  std::vector<Colour> pixels;
  pixels.reserve(std::size_t{kPixels} * kPixels);
  constexpr double kHalf = 0.5 * kPixels;
  for (std::uint32_t row = 0; row < kPixels; ++row)
    for (std::uint32_t column = 0; column < kPixels; ++column) {
      const double forward = (column + 0.5 - kHalf) / kHalf, across = (kHalf - row - 0.5) / kHalf;
      const double polar = 0.5 * core::kPi * std::hypot(forward, across);
      pixels.push_back(
          viridis(polar < 0.5 * core::kPi
                      ? share[analysis::hemisphere_grid().cell_at(polar, std::atan2(across, forward))]
                      : 0.0));
    }
  return png_data(pixels, kPixels, kPixels);
}

std::string circles() {
  std::string out;
  // The area beyond the horizon is covered.
  out += fmt::format(
      "<path class=\"beyond\" fill-rule=\"evenodd\" d=\"M0 0H{0}V{0}H0Z M{1} {2}a{3} {3} 0 1 0 {4} 0a{3} {3} "
      "0 1 "
      "0 -{4} 0Z\"/>\n",
      2.0 * kMiddle, kMiddle - kRadius, kMiddle, kRadius, 2.0 * kRadius);
  for (const int degrees : {30, 60, 90}) {
    const double radius = kRadius * degrees / 90.0;
    out += fmt::format("<circle class=\"ring\" cx=\"{0}\" cy=\"{0}\" r=\"{1:.1f}\"/>\n", kMiddle, radius);
    if (degrees < 90)
      out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}&#176;</text>\n", kMiddle + 3.0,
                         kMiddle - radius - 4.0, degrees);
  }
  out += fmt::format("<line class=\"ring\" x1=\"{:.1f}\" y1=\"{}\" x2=\"{:.1f}\" y2=\"{}\"/>\n",
                     kMiddle - kRadius, kMiddle, kMiddle + kRadius, kMiddle);
  return out;
}

std::string cross(double polar_rad) {
  const double x = kMiddle + kRadius * polar_rad / (0.5 * core::kPi), r = 7.0;
  return fmt::format(
      "<path class=\"cross\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}M{:.1f} {:.1f}L{:.1f} {:.1f}\"/>\n", x - r,
      kMiddle - r, x + r, kMiddle + r, x - r, kMiddle + r, x + r, kMiddle - r);
}

/// The cells of the hemisphere grid, for the script of pages.
PolarCells grid_cells() {
  const analysis::HemisphereGrid& grid = analysis::hemisphere_grid();
  PolarCells cells;
  cells.edges_deg.push_back(0.0);
  for (std::size_t k = 0; k < grid.size(); ++k) {
    const double high_deg = grid.cell(k).polar_high / core::kDegree;
    if (cells.edges_deg.back() != high_deg) {
      cells.edges_deg.push_back(high_deg);
      cells.count.push_back(0.0);
    }
    cells.count.back() += 1.0;
  }
  cells.middle = kMiddle;
  cells.radius = kRadius;
  cells.pixels = kPixels;
  return cells;
}

}  // namespace

std::string hemisphere_map(const analysis::DirectionCounts& counts, std::uint64_t rays, double mark_rad,
                           const std::string& alternative) {
  std::vector<double> density;
  for (std::size_t k = 0; k < counts.cells.size(); ++k)
    density.push_back(
        analysis::density_per_sr(counts.cells[k], rays, analysis::hemisphere_grid().cell(k).solid_angle_sr)
            .value);
  const double largest = std::max(1e-30, *std::max_element(density.begin(), density.end()));
  std::string out =
      fmt::format("<svg class=\"hemisphere\" viewBox=\"0 0 {0} {0}\" role=\"img\" aria-label=\"{1}\">\n",
                  2.0 * kMiddle, escape_html(alternative));
  out += fmt::format("<image x=\"{0}\" y=\"{0}\" width=\"{1}\" height=\"{1}\" href=\"{2}\"/>\n",
                     kMiddle - kRadius, 2.0 * kRadius, picture(shares(density, largest)));
  out += circles();
  if (mark_rad >= 0.0) out += cross(mark_rad);
  out += "</svg>\n";
  out += fmt::format(
      "<div class=\"scale\"><span>{:.3g}</span><i style=\"background:{}\"></i><span>{:.3g} per "
      "sr</span></div>\n",
      largest * std::pow(10.0, -kDecades), viridis_gradient(), largest);
  const std::string json =
      fmt::format("{{\"title\":{},\"value\":\"per sr\",\"decades\":{},\"values\":{}{}}}",
                  json_text(alternative), kDecades, json_numbers(density, 6), polar_json(grid_cells()));
  return chart_box("polar", alternative, out, json);
}

std::string hemisphere_map_style() {
  return R"css(
svg.hemisphere { display: block; width: 100%; height: auto; font: 13px system-ui, sans-serif; }
svg.hemisphere .beyond { fill: var(--paper); }
svg.hemisphere .ring { fill: none; stroke: #ffffff; stroke-opacity: .55; stroke-width: 1; }
svg.hemisphere text { fill: #ffffff; fill-opacity: .85; }
svg.hemisphere .cross { fill: none; stroke: #ff5a5a; stroke-width: 2; }
.scale { display: flex; align-items: center; gap: .6rem; color: var(--soft); font-size: .85rem;
  font-variant-numeric: tabular-nums; white-space: nowrap; margin: 0 5%; }
.scale i { flex: 1; height: .7rem; }
)css";
}

}  // namespace scintray::report
