// Where the headers of HDF5 objects have the values of attributes. Layout: HDF5 File Format
// Specification 3.0, sections IV.A.1 and IV.A.2.m, and of continuations IV.A.2.q
// (https://github.com/HDFGroup/hdf5, doxygen/examples/H5.format.html, commit 03a3f5c7), for addresses and
// lengths of 8 bytes.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include "scintray/core/detail/h5_internal.hpp"

namespace scintray::core::h5 {

namespace {

constexpr std::uint16_t kAttribute = 0x000C, kContinuation = 0x0010;
constexpr std::size_t kChecksumBytes = 4, kMarkBytes = 4;
constexpr unsigned kShared = 2;  // flag of a message

/// Numbers one after another; the first that is not there spoils all that follow.
class Bytes {
 public:
  Bytes(std::string_view all, std::uint64_t from, std::uint64_t length) : all_(all), at_(from) {
    end_ = from > all.size() || length > all.size() - from ? at_ : from + length;
  }
  template <typename T>
  T next() {
    T value{};
    if (left() < sizeof value) {
      at_ = end_;
      good_ = false;
    } else {
      std::memcpy(&value, all_.data() + at_, sizeof value);
      at_ += sizeof value;
    }
    return value;
  }
  void skip(std::uint64_t count) {
    good_ = good_ && count <= left();
    at_ = good_ ? at_ + count : end_;
  }
  std::uint64_t left() const { return end_ - at_; }
  std::uint64_t at() const { return at_; }
  bool good() const { return good_; }

 private:
  std::string_view all_;
  std::uint64_t at_, end_;
  bool good_ = true;
};

class AttributeSearch {
 public:
  AttributeSearch(std::string_view bytes, std::uint64_t base, std::string_view name)
      : bytes_(bytes), base_(base), name_(name) {}

  std::optional<std::uint64_t> in_header(std::uint64_t address) {
    if (address >= bytes_.size() || base_ >= bytes_.size() - address) return std::nullopt;
    Bytes prefix(bytes_, base_ + address, bytes_.size() - base_ - address);
    is_second_ = bytes_.substr(prefix.at()).starts_with("OHDR");
    std::uint64_t length = 0;
    if (is_second_) {
      prefix.skip(kMarkBytes + 1);
      flags_ = prefix.next<std::uint8_t>();
      constexpr unsigned kTimes = 1u << 5, kLimits = 1u << 4;
      if (flags_ & kTimes) prefix.skip(16);
      if (flags_ & kLimits) prefix.skip(4);
      switch (flags_ & 3u) {
        case 0:
          length = prefix.next<std::uint8_t>();
          break;
        case 1:
          length = prefix.next<std::uint16_t>();
          break;
        case 2:
          length = prefix.next<std::uint32_t>();
          break;
        default:
          length = prefix.next<std::uint64_t>();
      }
    } else {
      if (prefix.next<std::uint8_t>() != 1) return std::nullopt;
      prefix.skip(7);
      length = prefix.next<std::uint32_t>();
      prefix.skip(4);
    }
    if (!prefix.good()) return std::nullopt;
    chunks_.push_back({prefix.at(), length});
    for (std::size_t i = 0; i < chunks_.size() && i < kMostChunks; ++i)
      if (const auto found = in_chunk(chunks_[i])) return found;
    return std::nullopt;
  }

 private:
  static constexpr std::size_t kMostChunks = 10'000;
  struct Chunk {
    std::uint64_t from, length;
  };

  std::optional<std::uint64_t> in_chunk(const Chunk& chunk) {
    Bytes messages(bytes_, chunk.from, chunk.length);
    constexpr unsigned kOrdered = 1u << 2;
    const std::size_t envelope = !is_second_ ? 8 : flags_ & kOrdered ? 6 : 4;
    while (messages.left() >= envelope) {
      const std::uint16_t type = is_second_ ? messages.next<std::uint8_t>() : messages.next<std::uint16_t>();
      const auto size = messages.next<std::uint16_t>();
      const auto flags = messages.next<std::uint8_t>();
      messages.skip(envelope - (is_second_ ? 4 : 5));
      if (size > messages.left()) return std::nullopt;
      Bytes message(bytes_, messages.at(), size);
      messages.skip(size);
      if (type == kContinuation) add_continuation(message);
      if (type == kAttribute && !(flags & kShared))
        if (const auto found = in_attribute(message)) return found;
    }
    return std::nullopt;
  }

  void add_continuation(Bytes& message) {
    const auto address = message.next<std::uint64_t>(), length = message.next<std::uint64_t>();
    if (!message.good() || !seen_.insert(address).second) return;
    const std::uint64_t around = is_second_ ? kMarkBytes + kChecksumBytes : 0;
    if (length >= around)
      chunks_.push_back({base_ + address + (is_second_ ? kMarkBytes : 0), length - around});
  }

  std::optional<std::uint64_t> in_attribute(Bytes& message) const {
    const auto version = message.next<std::uint8_t>();
    message.skip(1);
    const auto name = message.next<std::uint16_t>(), type = message.next<std::uint16_t>(),
               space = message.next<std::uint16_t>();
    if (version == 3) message.skip(1);  // character set of the name
    const auto stored = [version](std::uint64_t size) { return version == 1 ? (size + 7) / 8 * 8 : size; };
    const std::uint64_t at = message.at();
    message.skip(stored(name));
    message.skip(stored(type));
    message.skip(stored(space));
    if (!message.good() || version < 1 || version > 3) return std::nullopt;
    const std::string_view known = bytes_.substr(at, name);
    if (known.substr(0, known.find('\0')) != name_) return std::nullopt;
    return message.at();
  }

  std::string_view bytes_;
  std::uint64_t base_;
  std::string_view name_;
  bool is_second_ = false;  ///< version 2 of the header
  unsigned flags_ = 0;
  std::vector<Chunk> chunks_;
  std::set<std::uint64_t> seen_;
};

}  // namespace

std::optional<std::uint64_t> attribute_values_at(std::string_view bytes, std::uint64_t base,
                                                 std::uint64_t header, const std::string& name) {
  return AttributeSearch(bytes, base, name).in_header(header);
}

}  // namespace scintray::core::h5
