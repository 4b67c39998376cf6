#pragma once
/// A number for each thread.

#include <atomic>

namespace scintray::core {

/// A small number of the calling thread's own: 1, 2, ... in the order of the first calls. For picking one of
/// several equal copies; results must not depend on it.
inline unsigned thread_slot() {
  static std::atomic<unsigned> last{0};
  static thread_local unsigned slot = 0;
  if (slot == 0) slot = ++last;
  return slot;
}

}  // namespace scintray::core
