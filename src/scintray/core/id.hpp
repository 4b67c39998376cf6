#pragma once
/// Typed indices: a type of index for each kind of object.

#include <cassert>
#include <compare>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>

namespace scintray::core {

/// The index of an object among those of its kind, or none. Ids of different kinds do not mix, and none is an
/// integer; an array over objects of one kind is an IdVector. 32 bits, plain data, none by default.
/// @tparam Tag  the kind; need not be defined
template <typename Tag>
class Id {
 public:
  /// None.
  constexpr Id() = default;
  /// @param index  below 2^32 - 1
  template <std::integral Index>
  explicit constexpr Id(Index index) : index_(static_cast<std::uint32_t>(index)) {
    assert(std::cmp_greater_equal(index, 0) && std::cmp_less(index, kNone));
  }

  /// No object. Comes after all others in the order.
  static constexpr Id none() { return {}; }

  constexpr bool has_value() const { return index_ != kNone; }
  /// @pre has_value()
  constexpr std::uint32_t index() const {
    assert(has_value());
    return index_;
  }

  friend constexpr auto operator<=>(const Id&, const Id&) = default;

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  std::uint32_t index_ = kNone;
};

}  // namespace scintray::core

template <typename Tag>
struct std::hash<scintray::core::Id<Tag>> {
  std::size_t operator()(const scintray::core::Id<Tag>& id) const {
    return id.has_value() ? std::size_t{id.index()} : std::numeric_limits<std::size_t>::max();
  }
};
