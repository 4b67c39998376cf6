#include "scintray/core/text.hpp"

namespace scintray::core {

std::string list_of(std::span<const std::string> words, std::string_view between) {
  return list_of(words, between, [](const std::string& word) -> const std::string& { return word; });
}

std::string list_quoted(std::span<const std::string> words) {
  return list_of(words, ", ", [](const std::string& word) { return '"' + word + '"'; });
}

}  // namespace scintray::core
