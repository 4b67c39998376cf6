#include "scintray/core/pattern.hpp"

#include <algorithm>
#include <cctype>

namespace scintray::core {

bool matches_pattern(std::string_view pattern, std::string_view name) {
  std::size_t p = 0, n = 0;
  std::size_t star = std::string_view::npos, resume = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      resume = n;
    } else if (p < pattern.size() && pattern[p] == name[n]) {
      ++p;
      ++n;
    } else if (star != std::string_view::npos) {  // the last star matches one character more
      p = star + 1;
      n = ++resume;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

std::size_t literal_length(std::string_view pattern) {
  return pattern.size() - static_cast<std::size_t>(std::count(pattern.begin(), pattern.end(), '*'));
}

std::vector<std::string> matching(std::string_view pattern, const std::vector<std::string>& names) {
  std::vector<std::string> found;
  for (const std::string& name : names)
    if (matches_pattern(pattern, name)) found.push_back(name);
  return found;
}

std::string pattern_of(const std::string& name) {
  std::string pattern;
  bool bracketed = false;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const std::size_t close = name[i] == '[' ? name.find(']', i) : std::string::npos;
    if (close == std::string::npos) {
      pattern += name[i];
      continue;
    }
    pattern += "[*]";
    bracketed = true;
    i = close;
  }
  if (bracketed) return pattern;
  // "part:face": the number is the part's.
  const std::size_t end = std::min(name.find(':'), name.size());
  std::size_t begin = end;
  while (begin > 0 && std::isdigit(static_cast<unsigned char>(name[begin - 1])) != 0) --begin;
  if (begin == end || begin == 0) return name;
  return name.substr(0, begin) + "*" + name.substr(end);
}

std::string with_patterns(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::size_t close = text[i] == '"' ? text.find('"', i + 1) : std::string::npos;
    if (close == std::string::npos) {
      result += text[i];
      continue;
    }
    result += '"' + pattern_of(text.substr(i + 1, close - i - 1)) + '"';
    i = close;
  }
  return result;
}

}  // namespace scintray::core
