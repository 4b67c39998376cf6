#pragma once
/// Arrays over objects that have an id.

#include <cassert>
#include <initializer_list>
#include <iterator>
#include <utility>
#include <vector>

#include "scintray/core/id.hpp"

namespace scintray::core {

/// The ids of the first `size` objects of a kind, in their order.
template <typename IdType>
class IdRange {
 public:
  class iterator {
   public:
    using value_type = IdType;
    using difference_type = std::ptrdiff_t;
    using reference = IdType;
    using pointer = void;
    using iterator_category = std::input_iterator_tag;

    constexpr iterator() = default;
    explicit constexpr iterator(std::size_t at) : at_(at) {}
    constexpr IdType operator*() const { return IdType(at_); }
    constexpr iterator& operator++() {
      ++at_;
      return *this;
    }
    constexpr iterator operator++(int) {
      const iterator before = *this;
      ++at_;
      return before;
    }
    bool operator==(const iterator&) const = default;

   private:
    std::size_t at_ = 0;
  };

  explicit constexpr IdRange(std::size_t size) : size_(size) {}
  constexpr iterator begin() const { return iterator(0); }
  constexpr iterator end() const { return iterator(size_); }
  constexpr std::size_t size() const { return size_; }

 private:
  std::size_t size_;
};

/// A value for each object of a kind: a std::vector that only that kind's ids index.
template <typename IdType, typename T>
class IdVector {
 public:
  using Values = std::vector<T>;
  using value_type = T;
  using reference = typename Values::reference;
  using const_reference = typename Values::const_reference;
  using iterator = typename Values::iterator;
  using const_iterator = typename Values::const_iterator;

  IdVector() = default;
  explicit IdVector(std::size_t size, const T& value = T()) : values_(size, value) {}
  IdVector(std::initializer_list<T> values) : values_(values) {}
  /// The object of index i has the i-th value.
  explicit IdVector(Values values) : values_(std::move(values)) {}

  /// @pre contains(id)
  reference operator[](IdType id) {
    assert(contains(id));
    return values_[id.index()];
  }
  const_reference operator[](IdType id) const {
    assert(contains(id));
    return values_[id.index()];
  }
  /// @throws std::out_of_range
  const_reference at(IdType id) const { return values_.at(id.index()); }
  bool contains(IdType id) const { return id.has_value() && id.index() < values_.size(); }

  /// The id of what comes next.
  IdType next_id() const { return IdType(values_.size()); }
  /// @return the id of the new object
  IdType push_back(T value) {
    values_.push_back(std::move(value));
    return IdType(values_.size() - 1);
  }
  template <typename... Arguments>
  IdType emplace_back(Arguments&&... arguments) {
    values_.emplace_back(std::forward<Arguments>(arguments)...);
    return IdType(values_.size() - 1);
  }
  void assign(std::size_t size, const T& value) { values_.assign(size, value); }
  void resize(std::size_t size, const T& value = T()) { values_.resize(size, value); }
  void reserve(std::size_t size) { values_.reserve(size); }
  void pop_back() { values_.pop_back(); }
  void clear() { values_.clear(); }

  std::size_t size() const { return values_.size(); }
  bool empty() const { return values_.empty(); }
  reference front() { return values_.front(); }
  const_reference front() const { return values_.front(); }
  reference back() { return values_.back(); }
  const_reference back() const { return values_.back(); }
  iterator begin() { return values_.begin(); }
  iterator end() { return values_.end(); }
  const_iterator begin() const { return values_.begin(); }
  const_iterator end() const { return values_.end(); }

  IdRange<IdType> ids() const { return IdRange<IdType>(values_.size()); }
  /// In the order of ids.
  const Values& values() const { return values_; }

  bool operator==(const IdVector&) const = default;

 private:
  Values values_;
};

}  // namespace scintray::core
