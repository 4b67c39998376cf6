#pragma once
/// Pixel images for pages.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace scintray::report {

struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0;
};

/// Colour of viridis (S. van der Walt and N. Smith 2015, CC0) at a share in [0, 1], clamped: equal steps,
/// linear between.
Colour viridis(double share);
/// The same colours from left to right, as a CSS background.
std::string viridis_gradient();

/// Bytes as text (RFC 4648, section 4).
std::string base64(std::span<const std::byte> bytes);

/// Pixels, row by row from the top, as "data:image/png;base64,...". `pixels` has width x height values.
/// Throws SystemError when the PNG library fails.
std::string png_data(const std::vector<Colour>& pixels, std::uint32_t width, std::uint32_t height);

}  // namespace scintray::report
