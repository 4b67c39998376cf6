#pragma once
/// Lists of items as text, and words in sentences.

#include <span>
#include <string>
#include <string_view>

namespace scintray::core {

/// The texts of the items in their order with `between` between neighbours; empty without items. `text_of`
/// returns the text of one item.
template <typename Range, typename TextOf>
std::string list_of(const Range& items, std::string_view between, TextOf&& text_of) {
  std::string list;
  bool first = true;
  for (const auto& item : items) {
    if (!first) list += between;
    first = false;
    list += text_of(item);
  }
  return list;
}

/// The list "a, b, c".
std::string list_of(std::span<const std::string> words, std::string_view between = ", ");

/// The same with each word in quotes.
std::string list_quoted(std::span<const std::string> words);

/// The noun after "a" or "an", by its first letter.
std::string with_article(const std::string& noun);

/// Two texts that differ only in the case of ASCII letters.
bool same_but_case(std::string_view a, std::string_view b);

}  // namespace scintray::core
