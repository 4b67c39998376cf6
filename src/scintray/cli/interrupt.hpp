#pragma once
/// Ctrl-C as a request to stop and to keep the result so far.

#include <atomic>

namespace scintray::cli {

/// During its lifetime SIGINT and SIGTERM set `requested()`; a second SIGINT ends the program at once.
/// Only one may exist at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  static const std::atomic<bool>& requested();
};

}  // namespace scintray::cli
