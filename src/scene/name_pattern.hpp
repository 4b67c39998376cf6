#pragma once
/// Names of parts with "*" for any characters, as "block[*]" or "block_septum*".

#include <string>
#include <vector>

namespace scintray {

/// True for a name with a "*".
bool is_pattern(const std::string& name);

/// True when the whole name matches; "*" stands for any characters or none, every other for itself.
bool matches(const std::string& pattern, const std::string& name);

/// Characters of a pattern that are spelt out: of two patterns that match, the one with more says more.
std::size_t literal_length(const std::string& pattern);

/// The names that match, in their order.
std::vector<std::string> matching(const std::string& pattern, const std::vector<std::string>& names);

}  // namespace scintray
