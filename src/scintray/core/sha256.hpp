#pragma once
/// SHA-256, to recognise content.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace scintray::core {

/// Hash of bytes that are added in pieces (FIPS 180-4, Secure Hash Standard, sections 4.1.2, 5 and 6.2).
class Sha256 {
 public:
  void add(std::string_view bytes);
  /// The hash of all bytes added, as 64 lower-case hexadecimal digits. Nothing may be added afterwards.
  std::string hex();

 private:
  void compress(const unsigned char* block);

  std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                      0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<unsigned char, 64> block_{};
  std::size_t filled_ = 0;  ///< bytes of block_ in use
  std::uint64_t length_ = 0;
};

/// The hash of one text, as Sha256::hex.
std::string sha256(std::string_view bytes);

}  // namespace scintray::core
