#include "scintray/report/height_image.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/transform_width.hpp>
#include <cmath>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/report/format.hpp"

namespace scintray::report {

namespace {

constexpr std::uint32_t kMostPixels = 600;

struct Colour {
  std::uint8_t red, green, blue;
};
constexpr Colour kMissing{150, 150, 150};

/// Viridis at equal steps, linear between.
Colour colour(double share) {
  constexpr std::array<std::array<double, 3>, 9> kViridis{{{68, 1, 84},
                                                           {71, 44, 122},
                                                           {59, 81, 139},
                                                           {44, 113, 142},
                                                           {33, 144, 141},
                                                           {39, 173, 129},
                                                           {92, 200, 99},
                                                           {170, 220, 50},
                                                           {253, 231, 37}}};
  const double at = std::clamp(share, 0.0, 1.0) * (kViridis.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(at), kViridis.size() - 2);
  const auto channel = [&](std::size_t k) {
    return static_cast<std::uint8_t>(
        std::lround(std::lerp(kViridis[below][k], kViridis[below + 1][k], at - static_cast<double>(below))));
  };
  return {channel(0), channel(1), channel(2)};
}

std::string base64(const std::vector<std::uint8_t>& bytes) {
  using namespace boost::archive::iterators;
  using Digits = base64_from_binary<transform_width<std::vector<std::uint8_t>::const_iterator, 6, 8>>;
  std::string text(Digits(bytes.begin()), Digits(bytes.end()));
  text.append((3 - bytes.size() % 3) % 3, '=');
  return text;
}

std::string png_data(const std::vector<Colour>& pixels, std::uint32_t width, std::uint32_t height) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = width;
  image.height = height;
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::vector<std::uint8_t> bytes(size);
  if (!png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels.data(), 0, nullptr))
    throw SystemError(std::string("cannot make a PNG picture: ") + image.message);
  bytes.resize(size);
  return "data:image/png;base64," + base64(bytes);
}

/// Mean of the heights under pixel (x, y), missing when all of them are.
double mean_under(const HeightMap& map, std::uint32_t x, std::uint32_t y, std::uint32_t block) {
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

std::string height_image(const HeightMap& map, double low_um, double high_um,
                         const std::string& alternative) {
  const std::uint32_t block = (std::max(map.columns, map.rows) + kMostPixels - 1) / kMostPixels;
  const std::uint32_t width = (map.columns + block - 1) / block, height = (map.rows + block - 1) / block;
  const double range = high_um > low_um ? high_um - low_um : 1.0;
  std::vector<Colour> pixels;
  pixels.reserve(std::size_t{width} * height);
  for (std::uint32_t y = 0; y < height; ++y)
    for (std::uint32_t x = 0; x < width; ++x) {
      const double mean = mean_under(map, x, y, block);
      pixels.push_back(std::isnan(mean) ? kMissing : colour((mean - low_um) / range));
    }
  // Pixels of the screen are square, points of the map need not be.
  return fmt::format("<img class=\"heights\" alt=\"{}\" style=\"aspect-ratio:{:.6g}/{:.6g}\" src=\"{}\"/>",
                     escape_html(alternative), map.columns * map.pitch_x_um, map.rows * map.pitch_y_um,
                     png_data(pixels, width, height));
}

std::string height_scale(double low_um, double high_um) {
  std::string stops;
  constexpr int kStops = 8;
  for (int k = 0; k <= kStops; ++k) {
    const Colour c = colour(static_cast<double>(k) / kStops);
    stops += fmt::format("{}rgb({},{},{})", k > 0 ? "," : "", c.red, c.green, c.blue);
  }
  return fmt::format(
      "<div class=\"scale\"><span>{:.3g} um</span><i style=\"background:linear-gradient(to right,{})\"></i>"
      "<span>{:.3g} um</span></div>",
      low_um, stops, high_um);
}

}  // namespace scintray::report
