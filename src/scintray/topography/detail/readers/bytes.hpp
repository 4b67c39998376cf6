#pragma once
/// Bounds-checked reading of binary data.

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "scintray/core/error.hpp"

namespace scintray::topography {

/// A position in a block of bytes that advances as numbers are read. Every member throws InputError, with the
/// byte, when the block ends too early.
class Bytes {
 public:
  /// `offset` is the start of the block in its file, for messages.
  Bytes(std::string_view data, std::string file, std::size_t offset = 0,
        std::endian order = std::endian::little)
      : data_(data), file_(std::move(file)), offset_(offset), order_(order) {}

  template <class T>
  T take() {
    static_assert(std::is_arithmetic_v<T>);
    const std::string_view raw = take_view(sizeof(T));
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), raw.data(), sizeof(T));
    if (order_ != std::endian::native) std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<T>(bytes);
  }

  std::string_view take_view(std::size_t size) {
    if (size > left()) fail(std::to_string(size) + " more bytes");
    const std::string_view result = data_.substr(at_, size);
    at_ += size;
    return result;
  }

  /// Text up to the next zero byte, which is consumed.
  std::string_view take_string() {
    const std::size_t end = data_.find('\0', at_);
    if (end == std::string_view::npos) fail("a text that ends");
    const std::string_view result = data_.substr(at_, end - at_);
    at_ = end + 1;
    return result;
  }

  void skip(std::size_t size) { take_view(size); }
  std::size_t left() const { return data_.size() - at_; }
  /// Position in bytes from the beginning of the file.
  std::size_t place() const { return offset_ + at_; }
  const std::string& file() const { return file_; }

  /// Throws InputError: "<what> expected at byte N, found only M".
  [[noreturn]] void fail(const std::string& what) const {
    throw core::InputError({{file_},
                            "the data end after " + std::to_string(left()) + " bytes at byte " +
                                std::to_string(place()) + "; expected " + what,
                            "the file is truncated or damaged"});
  }

 private:
  std::string_view data_;
  std::string file_;
  std::size_t offset_ = 0, at_ = 0;
  std::endian order_;
};

/// Storage type of a number.
enum class SampleType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t sample_size(SampleType type);

/// All numbers of a block whose size is a multiple of sample_size.
std::vector<double> decode_samples(std::string_view block, SampleType type,
                                   std::endian order = std::endian::little);

}  // namespace scintray::topography
