#include "scintray/report/plots/detail/height_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "scintray/report/plots/png_image.hpp"
#include "scintray/report/text/format.hpp"

namespace scintray::report {

namespace {

constexpr std::uint32_t kMostPixels = 600;

constexpr Colour kMissing{150, 150, 150};

/// Mean of the heights under pixel (x, y), missing when all of them are.
double mean_under(const topography::HeightMap& map, std::uint32_t x, std::uint32_t y, std::uint32_t block) {
  double sum = 0.0, count = 0.0;
  for (std::uint32_t j = y * block; j < std::min(map.rows, (y + 1) * block); ++j)
    for (std::uint32_t i = x * block; i < std::min(map.columns, (x + 1) * block); ++i) {
      if (std::isnan(map.at(i, j))) continue;
      sum += map.at(i, j);
      count += 1.0;
    }
  return count > 0.0 ? sum / count : std::nan("");
}

}  // namespace

std::string height_image(const topography::HeightMap& map, double low_um, double high_um,
                         const std::string& alternative) {
  const std::uint32_t block = (std::max(map.columns, map.rows) + kMostPixels - 1) / kMostPixels;
  const std::uint32_t width = (map.columns + block - 1) / block, height = (map.rows + block - 1) / block;
  const double range = high_um > low_um ? high_um - low_um : 1.0;
  std::vector<Colour> pixels;
  pixels.reserve(std::size_t{width} * height);
  for (std::uint32_t y = 0; y < height; ++y)
    for (std::uint32_t x = 0; x < width; ++x) {
      const double mean = mean_under(map, x, y, block);
      pixels.push_back(std::isnan(mean) ? kMissing : viridis((mean - low_um) / range));
    }
  // Pixels of the screen are square, points of the map need not be.
  return fmt::format("<img class=\"heights\" alt=\"{}\" style=\"aspect-ratio:{:.6g}/{:.6g}\" src=\"{}\"/>",
                     escape_html(alternative), map.columns * map.pitch_x_um, map.rows * map.pitch_y_um,
                     png_data(pixels, width, height));
}

std::string height_scale(double low_um, double high_um) {
  return fmt::format(
      "<div class=\"scale\"><span>{:.3g} um</span><i style=\"background:{}\"></i><span>{:.3g} "
      "um</span></div>",
      low_um, viridis_gradient(), high_um);
}

}  // namespace scintray::report
