#pragma once
/// Lines that are the same for many things.

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace scintray::cli {

/// The name with what is in square brackets, else with the number at its end, made a star: "crystal[*]"
/// for crystal[3,4], "pad*" for pad12, "crystal[*]:exit" for crystal[3,4]:exit.
std::string pattern_of(const std::string& name);

/// Things that share a line, in order of first appearance.
template <typename Thing>
class Alike {
 public:
  struct Line {
    std::size_t count = 0;
    Thing first;
  };

  /// The line of `key`, made with `first` when it is new, and counted.
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
