#pragma once
/// Progress of long work.

#include <chrono>
#include <condition_variable>
#include <functional>
#include <iosfwd>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "scintray/core/activity.hpp"

namespace scintray::cli {

/// Output of progress, and its clock.
struct ProgressOutput {
  using Clock = std::chrono::steady_clock;
  bool terminal = false;
  std::ostream* stream = nullptr;
  std::function<Clock::time_point()> now = Clock::now;

  /// Standard error.
  static ProgressOutput standard();
};

/// Progress of the work, with rate and time left: one line that is updated on a terminal; elsewhere, such as
/// in a log, a new line once a minute. Threads may share one.
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
  /// Shows the latest line again when it is due, with the time that the step has taken so far, during work
  /// that reports nothing. Nothing before the first show() or after clear().
  void repeat();
  /// Removes the line from a terminal.
  void clear();
  /// Restarts rate and time left.
  void restart();

 private:
  using Clock = ProgressOutput::Clock;
  bool is_due(Clock::duration terminal_interval, Clock::time_point now) const;
  void print(const std::string& line, Clock::time_point now);

  bool active_;
  ProgressOutput output_;
  std::mutex mutex_;
  bool shown_ = false;
  Clock::time_point start_, last_;
  std::string what_;         ///< of the latest line; empty after clear()
  double share_ = 0.0;       ///< its done / total
  Clock::time_point since_;  ///< when `what_` was first shown
};

/// Shows on a line the activities of the thread that made it (core/activity.hpp), and repeats the latest line
/// while nothing new is reported, until it is destroyed.
class ActivityWatch {
 public:
  /// @param interval  how often a repetition is considered
  explicit ActivityWatch(ProgressLine& line, std::chrono::milliseconds interval = std::chrono::seconds(1));
  ~ActivityWatch();
  ActivityWatch(const ActivityWatch&) = delete;
  ActivityWatch& operator=(const ActivityWatch&) = delete;

 private:
  std::string what_;  ///< of the latest activity
  core::ActivityObserver observer_;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool end_ = false;
  std::thread thread_;
};

/// The result of `work`, with its activities on standard error while it runs, `what` first; silent unless
/// `wanted`. Nothing may be printed within it.
template <typename Work>
auto with_progress(const std::string& what, Work&& work, bool wanted = true) {
  ProgressLine line(wanted);
  const ActivityWatch watch(line);
  core::report_activity(what);
  return std::forward<Work>(work)();
}

/// Text of a duration: "42 s", "3 min 10 s", "2 h 05 min".
std::string duration_text(double seconds);

}  // namespace scintray::cli
