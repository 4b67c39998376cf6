#pragma once
/// Ctrl-C as a request to stop and keep what was computed.

#include <atomic>

namespace scintray::cli {

/// While it lives, SIGINT and SIGTERM set `requested()`; a second SIGINT ends the program at once.
/// Only one may live at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  static const std::atomic<bool>& requested();
};

}  // namespace scintray::cli
