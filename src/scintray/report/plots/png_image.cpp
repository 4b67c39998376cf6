#include "scintray/report/plots/png_image.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/transform_width.hpp>
#include <cmath>

#include "scintray/core/error.hpp"

namespace scintray::report {

std::string base64(std::span<const std::byte> bytes) {
  using namespace boost::archive::iterators;
  using Digits = base64_from_binary<transform_width<const unsigned char*, 6, 8>>;
  const auto* const first = reinterpret_cast<const unsigned char*>(bytes.data());
  // The digits of the last bytes take up to two bytes more, which are zero here.
  std::vector<unsigned char> filled(first, first + bytes.size());
  filled.resize((bytes.size() + 2) / 3 * 3, 0);
  std::string text(Digits(filled.data()), Digits(filled.data() + filled.size()));
  const std::size_t padding = filled.size() - bytes.size();
  text.replace(text.size() - padding, padding, padding, '=');
  return text;
}

Colour viridis(double share) {
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

std::string viridis_gradient() {
  std::string stops;
  constexpr int kStops = 8;
  for (int k = 0; k <= kStops; ++k) {
    const Colour c = viridis(static_cast<double>(k) / kStops);
    stops += fmt::format(",rgb({},{},{})", c.red, c.green, c.blue);
  }
  return "linear-gradient(to right" + stops + ")";
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
    throw core::SystemError(std::string("cannot make a PNG picture: ") + image.message);
  bytes.resize(size);
  return "data:image/png;base64," + base64(std::as_bytes(std::span(bytes)));
}

}  // namespace scintray::report
