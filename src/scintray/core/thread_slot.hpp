#pragma once
/// Numbers of threads.

#include <atomic>

namespace scintray::core {

/// Number of the calling thread: 1, 2, ... in the order of the first calls. It selects one of several equal
/// copies; results must not depend on it.
inline unsigned thread_slot() {
  static std::atomic<unsigned> last{0};
  static thread_local unsigned slot = 0;
  if (slot == 0) slot = ++last;
  return slot;
}

}  // namespace scintray::core
