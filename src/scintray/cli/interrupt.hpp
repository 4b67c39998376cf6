#pragma once
/// Ctrl-C, and the signals by which systems end programs, as a request to stop and keep the partial result.

#include <atomic>

namespace scintray::cli {

/// During its lifetime SIGINT, SIGTERM and SIGHUP set `requested()`; a second signal ends the program at
/// once. SIGPIPE is ignored, so that a closed pipe does not end a run. Only one may exist at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  static const std::atomic<bool>& requested();
  /// Sets whether there is a result to keep. Where there is none, as at first while a scene is read and
  /// built, a signal ends the program with exit code kInterrupted after two seconds, if it has not ended by
  /// then.
  static void keeps_results(bool keeps);
};

}  // namespace scintray::cli
