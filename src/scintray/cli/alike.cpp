#include "scintray/cli/alike.hpp"

#include <cctype>

namespace scintray::cli {

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

}  // namespace scintray::cli
