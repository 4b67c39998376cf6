#pragma once
/// Names with wildcards.

#include <string_view>

namespace scintray {

/// True when `name` is what `pattern` says, where every * stands for any run of characters, also none.
bool matches_pattern(std::string_view pattern, std::string_view name);

inline bool is_pattern(std::string_view text) { return text.find('*') != std::string_view::npos; }

}  // namespace scintray
