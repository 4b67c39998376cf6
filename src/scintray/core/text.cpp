#include "scintray/core/text.hpp"

#include <algorithm>
#include <cctype>

namespace scintray::core {

std::string list_of(std::span<const std::string> words, std::string_view between) {
  return list_of(words, between, [](const std::string& word) -> const std::string& { return word; });
}

std::string list_quoted(std::span<const std::string> words) {
  return list_of(words, ", ", [](const std::string& word) { return '"' + word + '"'; });
}

std::string with_article(const std::string& noun) {
  const bool vowel =
      !noun.empty() && std::string_view("aeiouAEIOU").find(noun.front()) != std::string_view::npos;
  return (vowel ? "an " : "a ") + noun;
}

bool same_but_case(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char x, char y) { return lower(x) == lower(y); });
}

}  // namespace scintray::core
