#pragma once
/// Items of output that share one line.

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace scintray::cli {

/// The text with every number replaced by a star.
inline std::string without_numbers(const std::string& text) {
  std::string result;
  for (const char c : text) {
    const bool digit = std::string("0123456789.-+e").find(c) != std::string::npos;
    if (!digit) {
      result += c;
    } else if (result.empty() || result.back() != '*') {
      result += '*';
    }
  }
  return result;
}

/// Items that share a line, in order of first appearance.
template <typename Thing>
class Alike {
 public:
  struct Line {
    std::size_t count = 0;
    Thing first;
  };

  /// The line of `key`, created with `first` when it is new, and counted.
  Line& add(const std::string& key, const Thing& first) {
    const auto [known, is_new] = index_.try_emplace(key, lines_.size());
    if (is_new) lines_.push_back({0, first});
    Line& line = lines_[known->second];
    ++line.count;
    return line;
  }
  const std::vector<Line>& lines() const { return lines_; }

 private:
  std::map<std::string, std::size_t> index_;
  std::vector<Line> lines_;
};

}  // namespace scintray::cli
