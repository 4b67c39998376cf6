#include "scintray/scene/name_pattern.hpp"

#include <algorithm>
#include <string_view>

namespace scintray {

bool is_pattern(const std::string& name) { return name.find('*') != std::string::npos; }

bool matches(const std::string& pattern, const std::string& name) {
  // Each stretch between stars is found at its first place after the one before it; only the last has to
  // end the name. Taking the first place never spoils a match, since stars take up what is skipped.
  const auto first = pattern.find('*');
  if (first == std::string::npos) return pattern == name;
  if (name.compare(0, first, pattern, 0, first) != 0) return false;
  std::size_t at = first, begin = first + 1;
  for (auto star = pattern.find('*', begin); star != std::string::npos; star = pattern.find('*', begin)) {
    const std::string_view stretch = std::string_view(pattern).substr(begin, star - begin);
    const auto found = name.find(stretch, at);
    if (found == std::string::npos) return false;
    at = found + stretch.size();
    begin = star + 1;
  }
  const std::string_view tail = std::string_view(pattern).substr(begin);
  return name.size() >= at + tail.size() && std::string_view(name).ends_with(tail);
}

std::size_t literal_length(const std::string& pattern) {
  return pattern.size() - static_cast<std::size_t>(std::count(pattern.begin(), pattern.end(), '*'));
}

std::vector<std::string> matching(const std::string& pattern, const std::vector<std::string>& names) {
  std::vector<std::string> found;
  for (const std::string& name : names)
    if (matches(pattern, name)) found.push_back(name);
  return found;
}

}  // namespace scintray
