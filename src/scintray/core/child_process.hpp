#pragma once
/// Work that may crash, done in a child process.

#include <cstddef>
#include <functional>
#include <string>

namespace scintray::core {

/// Result of work in a child process.
struct ChildAnswer {
  std::string bytes;    ///< the bytes that the work returned; incomplete unless `trouble` is empty
  std::string trouble;  ///< why the child failed, in words; empty when it succeeded
};

/// The bytes that `work` returns when it runs in a copy (fork) of this process. A crash, an excessive
/// allocation or an endless loop ends the copy only: it may allocate `most_bytes` more than this process has
/// now, and use `most_seconds` of processor time. `work` must not throw, must not use threads that run
/// already or locks that they may hold; nothing of it remains but its result. Throws SystemError when no
/// process can be created.
[[nodiscard]] ChildAnswer run_in_child(const std::function<std::string()>& work, std::size_t most_bytes,
                                       unsigned most_seconds);

/// From now on run_in_child does its work in place: for a process that is itself a child whose end harms
/// nobody, and that has more of such work than processes can be made for.
void work_in_place();

}  // namespace scintray::core
