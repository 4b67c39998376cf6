#pragma once
/// Values as bytes: one function for each type serves writer and reader.
///
/// Numbers are stored as they are in memory, the least significant byte first, so that all bits return.

#include <array>
#include <bit>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "scintray/core/exact_sum.hpp"
#include "scintray/core/id.hpp"
#include "scintray/core/id_vector.hpp"
#include "scintray/core/vec.hpp"

namespace scintray::simulation::detail {

static_assert(std::endian::native == std::endian::little, "files of block ranges are little-endian");

/// Thrown for bytes that are not what was written. Not seen outside of the reader.
struct Undecodable {};

/// Writer of values as bytes.
class Encoder {
 public:
  static constexpr bool kReads = false;

  template <typename T>
  void plain(T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
  }
  template <typename T>
  void plain_list(std::vector<T>& values) {
    std::uint64_t count = values.size();
    plain(count);
    bytes.append(reinterpret_cast<const char*>(values.data()), count * sizeof(T));
  }
  void text(std::string& value) {
    std::uint64_t count = value.size();
    plain(count);
    bytes.append(value);
  }

  std::string bytes;
};

/// Reader of values. @throws Undecodable
class Decoder {
 public:
  static constexpr bool kReads = true;

  explicit Decoder(std::string_view bytes) : left_(bytes) {}

  template <typename T>
  void plain(T& value) {
    std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
  }
  template <typename T>
  void plain_list(std::vector<T>& values) {
    std::uint64_t count = 0;
    plain(count);
    if (count > left_.size() / sizeof(T)) throw Undecodable();
    values.resize(count);
    if (count > 0) std::memcpy(values.data(), take(count * sizeof(T)).data(), count * sizeof(T));
  }
  void text(std::string& value) {
    std::uint64_t count = 0;
    plain(count);
    value = take(count);
  }
  bool at_end() const { return left_.empty(); }

 private:
  std::string_view take(std::uint64_t count) {
    if (count > left_.size()) throw Undecodable();
    const std::string_view taken = left_.substr(0, count);
    left_.remove_prefix(count);
    return taken;
  }
  std::string_view left_;
};

// exchange(archive, value) writes or reads one value; pass(archive, values...) several, in the order of the
// file.

template <typename A, typename... T>
void pass(A& archive, T&... values);

template <typename A, typename T>
requires std::is_arithmetic_v<T>
void exchange(A& archive, T& value) { archive.plain(value); }

template <typename A>
void exchange(A& archive, bool& value) {
  std::uint8_t byte = value ? 1 : 0;
  archive.plain(byte);
  value = byte != 0;
}

template <typename A, typename T>
requires std::is_enum_v<T>
void exchange(A& archive, T& value) {
  auto number = static_cast<std::int32_t>(value);
  archive.plain(number);
  value = static_cast<T>(number);
}

template <typename A>
void exchange(A& archive, std::string& value) {
  archive.text(value);
}

template <typename A, typename Tag>
void exchange(A& archive, core::Id<Tag>& id) {
  constexpr std::uint32_t kNone = 0xffffffffu;
  std::uint32_t index = id.has_value() ? id.index() : kNone;
  archive.plain(index);
  id = index == kNone ? core::Id<Tag>() : core::Id<Tag>(index);
}

template <typename A>
void exchange(A& archive, core::Vec3& value) {
  pass(archive, value.x(), value.y(), value.z());
}

template <typename A, typename T, std::size_t N>
void exchange(A& archive, std::array<T, N>& values) {
  for (T& value : values) pass(archive, value);
}

template <typename A, typename T>
void exchange(A& archive, std::vector<T>& values) {
  if constexpr (std::is_arithmetic_v<T>) {
    archive.plain_list(values);
  } else {
    std::uint64_t count = values.size();
    archive.plain(count);
    if constexpr (A::kReads) {
      values.clear();  // each takes a byte or more, so that a wrong count ends with the bytes
      for (std::uint64_t i = 0; i < count; ++i) pass(archive, values.emplace_back());
    } else {
      for (T& value : values) pass(archive, value);
    }
  }
}

template <typename A, typename IdType, typename T>
void exchange(A& archive, core::IdVector<IdType, T>& values) {
  std::vector<T> list = values.values();
  pass(archive, list);
  if constexpr (A::kReads) values = core::IdVector<IdType, T>(std::move(list));
}

template <typename A, typename T>
void exchange(A& archive, std::optional<T>& value) {
  bool has = value.has_value();
  pass(archive, has);
  if constexpr (A::kReads) {
    value.reset();
    if (has) value.emplace();
  }
  if (has) pass(archive, *value);
}

/// Words most of which may be zero: numbers of zeros and of others in turns, the others in full.
template <typename A>
void exchange_sparse(A& archive, std::vector<std::uint64_t>& words) {
  constexpr std::uint64_t kMostWords = 80'000'000;  // of two words of four for each bin of the largest tally
  std::uint64_t count = words.size();
  archive.plain(count);
  if constexpr (A::kReads) {
    if (count > kMostWords) throw Undecodable();
    words.clear();
  }
  for (std::uint64_t at = 0; at < count;) {
    std::uint64_t zeros = 0;
    std::vector<std::uint64_t> others;
    if constexpr (!A::kReads) {
      while (at + zeros < count && words[at + zeros] == 0) ++zeros;
      for (std::uint64_t k = at + zeros; k < count && words[k] != 0; ++k) others.push_back(words[k]);
    }
    pass(archive, zeros, others);
    if constexpr (A::kReads) {
      const std::uint64_t left = count - at;
      if (zeros > left || others.size() > left - zeros || zeros + others.size() == 0) throw Undecodable();
      words.resize(at + zeros, 0);
      words.insert(words.end(), others.begin(), others.end());
    }
    at += zeros + others.size();
  }
}

template <typename A>
void exchange(A& archive, core::ExactSum& sum) {
  core::ExactSum::Words words = sum.words();
  pass(archive, words);
  sum = core::ExactSum::from_words(words);
}

template <typename A>
void exchange_sparse(A& archive, std::vector<core::ExactSum>& sums) {
  std::vector<std::uint64_t> words;
  for (const core::ExactSum& sum : sums) words.insert(words.end(), sum.words().begin(), sum.words().end());
  exchange_sparse(archive, words);
  if constexpr (A::kReads) {
    if (words.size() % 4 != 0) throw Undecodable();
    sums.clear();
    for (std::size_t i = 0; i < words.size(); i += 4)
      sums.push_back(core::ExactSum::from_words({words[i], words[i + 1], words[i + 2], words[i + 3]}));
  }
}

template <typename A, typename... T>
void pass(A& archive, T&... values) {
  (exchange(archive, values), ...);
}

/// Bytes of values.
template <typename... T>
std::string encoded(const T&... values) {
  Encoder encoder;
  pass(encoder, const_cast<T&>(values)...);  // an Encoder only reads them
  return std::move(encoder.bytes);
}

}  // namespace scintray::simulation::detail
