#include <algorithm>

#include "scintray/core/error.hpp"
#include "scintray/core/zlib_stream.hpp"
#include "scintray/topography/detail/readers/formats.hpp"

namespace scintray::topography {

namespace {

/// The last four bytes: the unpacked size modulo 2^32 (RFC 1952, section 2.3.1).
std::size_t declared_size(std::string_view packed) {
  std::uint32_t size = 0;
  if (packed.size() >= 18)
    for (int k = 3; k >= 0; --k)
      size = size << 8 | static_cast<unsigned char>(packed[packed.size() - 4 + static_cast<std::size_t>(k)]);
  return size;
}

}  // namespace

std::string gunzip(std::string_view packed, const std::string& file, std::size_t most) {
  const std::size_t limit = std::min(most, core::most_unpacked(packed.size()));
  const std::size_t declared = declared_size(packed);
  const auto refuse = [&](const std::string& what) {
    throw core::InputError({{file},
                            "gzip data of " + std::to_string(packed.size()) + " bytes that " + what +
                                "; expected at most " + std::to_string(limit),
                            "the file is truncated or damaged, or holds no height map"});
  };
  if (declared > limit) refuse("declare to unpack to " + std::to_string(declared) + " bytes");
  std::string content;
  const core::Unpacked end = core::unpack(packed, core::Packing::gzip, [&](std::string_view part) {
    content += part;
    if (content.size() > limit) refuse("unpack to more bytes");
  });
  if (!end.complete)
    throw core::InputError(
        {{file}, "damaged or truncated gzip data", "unpack it with gunzip to see what is left"});
  if (end.bytes_after > 0)
    throw core::InputError(
        {{file},
         std::to_string(end.bytes_after) + " bytes after the end of the gzip data; expected none",
         "pack one file only"});
  return content;
}

}  // namespace scintray::topography
