#pragma once
/// Progress of long work.

#include <chrono>
#include <functional>
#include <iosfwd>
#include <string>

namespace scintray::cli {

/// Where progress is shown, and the clock that it goes by.
struct ProgressOutput {
  using Clock = std::chrono::steady_clock;
  bool terminal = false;
  std::ostream* stream = nullptr;
  std::function<Clock::time_point()> now = Clock::now;

  /// Standard error.
  static ProgressOutput standard();
};

/// Progress of the work, with rate and time left: one line that is updated on a terminal; elsewhere, as in a
/// log, a line of its own once a minute.
class ProgressLine {
 public:
  /// Silent unless `wanted`.
  explicit ProgressLine(bool wanted, ProgressOutput output = ProgressOutput::standard());
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Shows `done` of `total` items, at most ten times a second on a terminal and once a minute elsewhere;
  /// only `what` when `total` is 0. `what` comes first, such as "point 3/15".
  void show(const std::string& what, double done, double total, const std::string& thing);
  /// Removes the line from a terminal.
  void clear();
  /// Restarts rate and time left.
  void restart();

 private:
  using Clock = ProgressOutput::Clock;

  bool active_;
  ProgressOutput output_;
  bool shown_ = false;
  Clock::time_point start_, last_;
};

/// Text of a duration: "42 s", "3 min 10 s", "2 h 05 min".
std::string duration_text(double seconds);

}  // namespace scintray::cli
