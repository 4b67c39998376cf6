#pragma once
/// Ids in a results file.

#include <cstdint>
#include <limits>

#include "scintray/core/id.hpp"

namespace scintray::results::format {

/// Value in a file for an id without a value.
inline constexpr std::uint32_t kNoIdInFile = std::numeric_limits<std::uint32_t>::max();

/// Value as stored in a file: an id is its index, a count or number of 64 bits is signed, since NumPy and
/// pandas refuse unsigned ones as indices, other values are unchanged.
/// @pre a count is below 2^63
inline std::int64_t to_file(std::uint64_t count) { return static_cast<std::int64_t>(count); }
template <typename Value>
const Value& to_file(const Value& value) {
  return value;
}
template <typename Tag>
std::uint32_t to_file(core::Id<Tag> id) {
  return id.has_value() ? id.index() : kNoIdInFile;
}

/// Sets the value from the one `stored` in a file.
inline void from_file(std::int64_t stored, std::uint64_t& count) {
  count = static_cast<std::uint64_t>(stored);
}
template <typename Value>
void from_file(const Value& stored, Value& value) {
  value = stored;
}
template <typename Tag>
void from_file(std::uint32_t stored, core::Id<Tag>& id) {
  id = stored == kNoIdInFile ? core::Id<Tag>::none() : core::Id<Tag>(stored);
}

}  // namespace scintray::results::format
