#pragma once
/// Doing in a child process what may crash.

#include <cstddef>
#include <functional>
#include <string>

namespace scintray::core {

/// What became of the work.
struct ChildAnswer {
  std::string bytes;    ///< what the work returned; incomplete unless `trouble` is empty
  std::string trouble;  ///< how the child ended when it did not end well, in words
};

/// Runs `work` in a copy of this process and returns what it returns. A crash, a million-fold allocation or
/// an endless loop ends the copy only: it may take `most_bytes` more of memory than this process has now, and
/// `most_seconds` of processor time. `work` must not throw, must not use threads that run already or locks
/// that they may hold, and leaves nothing behind but its answer. Throws SystemError when no process can be
/// made.
[[nodiscard]] ChildAnswer run_in_child(const std::function<std::string()>& work, std::size_t most_bytes,
                                       unsigned most_seconds);

}  // namespace scintray::core
