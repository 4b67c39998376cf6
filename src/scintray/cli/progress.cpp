#include "scintray/cli/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <iostream>

namespace scintray::cli {

namespace {

constexpr std::chrono::milliseconds kTerminalInterval{100};
constexpr std::chrono::seconds kTerminalRepetition{2};
constexpr std::chrono::seconds kLogInterval{60};

/// 1234567 as "1.23 M".
std::string rate_text(double per_second) {
  if (per_second >= 1e6) return fmt::format("{:.2f} M", per_second / 1e6);
  if (per_second >= 1e3) return fmt::format("{:.0f} k", per_second / 1e3);
  return fmt::format("{:.0f} ", per_second);
}

}  // namespace

std::string duration_text(double seconds) {
  const auto total = static_cast<long>(std::ceil(std::max(0.0, seconds)));
  if (total < 60) return fmt::format("{} s", total);
  if (total < 3600) return fmt::format("{} min {:02} s", total / 60, total % 60);
  return fmt::format("{} h {:02} min", total / 3600, (total % 3600) / 60);
}

ProgressOutput ProgressOutput::standard() {
  return {isatty(STDERR_FILENO) == 1, &std::cerr, ProgressOutput::Clock::now};
}

// Nothing is due at once in a log: work of less than a minute leaves no line there.
ProgressLine::ProgressLine(bool wanted, ProgressOutput output)
    : active_(wanted),
      output_(std::move(output)),
      start_(output_.now()),
      last_(output_.terminal ? Clock::time_point() : start_) {}

ProgressLine::~ProgressLine() { clear(); }

void ProgressLine::restart() {
  const std::lock_guard lock(mutex_);
  start_ = output_.now();
}

bool ProgressLine::is_due(Clock::duration terminal_interval, Clock::time_point now) const {
  return now - last_ >= (output_.terminal ? terminal_interval : Clock::duration(kLogInterval));
}

void ProgressLine::print(const std::string& line, Clock::time_point now) {
  last_ = now;
  *output_.stream << (output_.terminal ? "\r\033[K" + line : line + "\n") << std::flush;
  shown_ = output_.terminal;
}

void ProgressLine::show(const std::string& what, double done, double total, const std::string& thing) {
  if (!active_) return;
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = output_.now();
  if (what != what_) since_ = now;
  what_ = what;
  share_ = total > 0.0 ? done / total : 0.0;
  if (!is_due(kTerminalInterval, now)) return;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const double rate = elapsed > 0.0 ? done / elapsed : 0.0;
  std::string line = what;
  if (total > 0.0) line += fmt::format("  {:3.0f} %", 100.0 * done / total);
  if (!thing.empty() && rate > 0.0) line += fmt::format("  {}{}/s", rate_text(rate), thing);
  if (rate > 0.0 && done < total) line += "  " + duration_text((total - done) / rate) + " left";
  print(line, now);
}

void ProgressLine::repeat() {
  const std::lock_guard lock(mutex_);
  if (!active_ || what_.empty()) return;
  const Clock::time_point now = output_.now();
  if (!is_due(kTerminalRepetition, now)) return;
  std::string line = what_;
  if (share_ > 0.0) line += fmt::format("  {:3.0f} %", 100.0 * share_);
  print(line + "  for " + duration_text(std::chrono::duration<double>(now - since_).count()), now);
}

void ProgressLine::clear() {
  const std::lock_guard lock(mutex_);
  if (shown_) *output_.stream << "\r\033[K" << std::flush;
  shown_ = false;
  what_.clear();
}

ActivityWatch::ActivityWatch(ProgressLine& line, std::chrono::milliseconds interval)
    : observer_([this, &line](const core::Activity& activity) {
        // Rate and time left are of one step; "placing parts: a" and "placing parts: b" are the same one.
        const std::string step = activity.what.substr(0, activity.what.find(':'));
        if (step != what_) line.restart();
        what_ = step;
        line.show(activity.what, static_cast<double>(activity.done), static_cast<double>(activity.total), "");
      }),
      thread_([this, &line, interval] {
        std::unique_lock lock(mutex_);
        while (!ended_.wait_for(lock, interval, [this] { return end_; })) line.repeat();
      }) {}

ActivityWatch::~ActivityWatch() {
  {
    const std::lock_guard lock(mutex_);
    end_ = true;
  }
  ended_.notify_all();
  thread_.join();
}

}  // namespace scintray::cli
