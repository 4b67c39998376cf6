#pragma once
/// Names with wildcards.

#include <string>
#include <string_view>
#include <vector>

namespace scintray::core {

/// True when `name` is what `pattern` states, where every * stands for any run of characters, also none.
bool matches_pattern(std::string_view pattern, std::string_view name);

inline bool is_pattern(std::string_view text) { return text.find('*') != std::string_view::npos; }

/// Characters of a pattern that are spelt out: of two that match, the one with more states more.
std::size_t literal_length(std::string_view pattern);

/// The names that match, in their order.
std::vector<std::string> matching(std::string_view pattern, const std::vector<std::string>& names);

}  // namespace scintray::core
