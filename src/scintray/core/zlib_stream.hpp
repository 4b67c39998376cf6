#pragma once
/// Streaming compression and decompression: zlib (RFC 1950) and gzip (RFC 1952).

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>

namespace scintray::core {

/// Receiver of the next bytes of a stream, at most 16 KiB at once. An exception of it ends the stream.
using TakeBytes = std::function<void(std::string_view)>;

/// Format of a stream's header.
enum class Packing { zlib, gzip };

/// State at the end of a stream.
struct Unpacked {
  bool complete = false;        ///< the end of the stream was reached and its check sum is right
  std::size_t bytes_after = 0;  ///< input beyond the end of the stream
};

/// Unpacks one stream into `take`, which receives all that can be unpacked of a damaged or truncated one.
/// @throws SystemError when zlib cannot start
Unpacked unpack(std::string_view packed, Packing packing, const TakeBytes& take);

/// CRC-32 of bytes as in gzip and PNG (RFC 1952, section 8).
/// @param before  of the bytes before these
std::uint32_t crc32(std::string_view bytes, std::uint32_t before = 0);

/// A zlib stream being written.
class Packer {
 public:
  /// @throws SystemError when zlib cannot start
  Packer();
  ~Packer();
  Packer(const Packer&) = delete;
  Packer& operator=(const Packer&) = delete;

  void add(std::string_view text, const TakeBytes& take);
  /// Ends the stream; nothing may be added after.
  void finish(const TakeBytes& take);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace scintray::core
