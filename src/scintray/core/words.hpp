#pragma once
/// Words of a file format and the values that they represent.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scintray/core/error.hpp"

namespace scintray::core {

/// A word and the value that it represents: an enumerator, or the function that reads what the word begins.
/// The words of an enum are a constexpr array beside it.
template <typename T>
struct Word {
  const char* word;
  T value;
};

/// The value of a word; empty when it is none of `words`. Of two equal words the first counts.
template <typename T, std::size_t N>
[[nodiscard]] constexpr std::optional<T> find_word(const Word<T> (&words)[N], std::string_view text) {
  for (const Word<T>& known : words)
    if (text == known.word) return known.value;
  return std::nullopt;
}

/// The first word of a value. @throws InternalError when it has no word
template <typename T, std::size_t N>
[[nodiscard]] constexpr const char* word_of(const Word<T> (&words)[N], const T& value) {
  for (const Word<T>& known : words)
    if (known.value == value) return known.word;
  throw InternalError("a value without a word");
}

/// The words alone, in their order.
template <typename T, std::size_t N>
[[nodiscard]] std::vector<std::string> word_list(const Word<T> (&words)[N]) {
  std::vector<std::string> list;
  for (const Word<T>& known : words) list.emplace_back(known.word);
  return list;
}

}  // namespace scintray::core
