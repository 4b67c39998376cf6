#include <zlib.h>

#include <algorithm>
#include <memory>

#include "scintray/core/error.hpp"
#include "scintray/topography/readers/formats.hpp"

namespace scintray {

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
  const std::size_t limit = std::min(most, most_unpacked(packed.size()));
  const std::size_t declared = declared_size(packed);
  const auto refuse = [&](const std::string& what) {
    throw InputError({{file},
                      "gzip data of " + std::to_string(packed.size()) + " bytes that " + what +
                          "; expected at most " + std::to_string(limit),
                      "the file is truncated or damaged, or holds no height map"});
  };
  if (declared > limit) refuse("declare to unpack to " + std::to_string(declared) + " bytes");
  z_stream stream{};
  constexpr int kGzipOnly = 15 + 16;
  if (inflateInit2(&stream, kGzipOnly) != Z_OK) throw SystemError("cannot start zlib");
  const std::unique_ptr<z_stream, int (*)(z_stream*)> guard(&stream, inflateEnd);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  std::string content, part(1 << 16, '\0');
  int state = Z_OK;
  while (state == Z_OK) {
    stream.next_out = reinterpret_cast<Bytef*>(part.data());
    stream.avail_out = static_cast<uInt>(part.size());
    state = inflate(&stream, Z_NO_FLUSH);
    content.append(part, 0, part.size() - stream.avail_out);
    if (content.size() > limit) refuse("unpack to more bytes");
  }
  if (state != Z_STREAM_END)
    throw InputError({{file}, "damaged or truncated gzip data", "unpack it with gunzip to see what is left"});
  if (stream.avail_in > 0)
    throw InputError(
        {{file},
         std::to_string(stream.avail_in) + " bytes after the end of the gzip data; expected none",
         "pack one file only"});
  return content;
}

}  // namespace scintray
