#pragma once
/// Progress on a terminal; silent in a pipe or a file.

#include <chrono>
#include <iosfwd>
#include <string>

namespace scintray::cli {

/// One line on standard error that is updated during the work, with rate and time left.
class ProgressLine {
 public:
  /// Silent unless standard error is a terminal and `wanted`.
  explicit ProgressLine(bool wanted);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Shows `done` of `total` items, at most ten times a second. `what` comes first, such as "point 3/15".
  void show(const std::string& what, double done, double total, const std::string& thing);
  /// Removes the line.
  void clear();
  /// Restarts rate and time left.
  void restart();

 private:
  bool active_;
  bool shown_ = false;
  std::chrono::steady_clock::time_point start_, last_;
};

/// Text of a duration: "42 s", "3 min 10 s", "2 h 05 min".
std::string duration_text(double seconds);

}  // namespace scintray::cli
