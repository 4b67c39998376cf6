#pragma once
/// Patterns of names with wildcards.

#include <string>
#include <string_view>
#include <vector>

namespace scintray::core {

/// True when `name` matches `pattern`, where each * matches any number of characters, also none.
bool matches_pattern(std::string_view pattern, std::string_view name);

inline bool is_pattern(std::string_view text) { return text.find('*') != std::string_view::npos; }

/// Number of literal characters of a pattern: of two that match, the one with more is the more specific.
std::size_t literal_length(std::string_view pattern);

/// The matching names, in their order.
std::vector<std::string> matching(std::string_view pattern, const std::vector<std::string>& names);

/// Pattern of a name, with the content of square brackets, else the number at its end, replaced by a star:
/// "crystal[*]" for crystal[3,4], "pad*" for pad12, "crystal[*]:exit" for crystal[3,4]:exit.
std::string pattern_of(const std::string& name);

/// A text with every name in double quotes replaced by its pattern.
std::string with_patterns(const std::string& text);

}  // namespace scintray::core
