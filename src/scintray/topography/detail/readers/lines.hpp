#pragma once
/// A text, line by line.

#include <algorithm>
#include <optional>
#include <string_view>

namespace scintray::topography {

/// Splits a text into numbered lines.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text), size_(text.size()) {}

  /// The next line without its end; empty (nullopt) after the last.
  std::optional<std::string_view> next() {
    if (rest_.empty()) return std::nullopt;
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++number_;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return line;
  }

  /// Number of the last line read, from 1.
  long number() const { return number_; }
  /// Bytes read so far.
  std::size_t place() const { return size_ - rest_.size(); }

 private:
  std::string_view rest_;
  std::size_t size_ = 0;
  long number_ = 0;
};

}  // namespace scintray::topography
