#pragma once
/// The order that TBB guarantees between pieces of work, stated for the thread sanitizer: TBB's library is
/// not instrumented, so that the sanitizer does not see it. Nothing is compiled without the sanitizer.

#if defined(__SANITIZE_THREAD__)
#define SCINTRAY_THREAD_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define SCINTRAY_THREAD_SANITIZER 1
#endif
#endif

#ifdef SCINTRAY_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
/// Of a function that reads what TBB copied to it, before it can state the order.
#define SCINTRAY_UNSEEN_BY_THREAD_SANITIZER __attribute__((no_sanitize_thread))
#else
#define SCINTRAY_UNSEEN_BY_THREAD_SANITIZER
#endif

namespace scintray::transport {

/// What this thread has done is seen by every thread that calls happens_after() on the same address later.
inline void happens_before([[maybe_unused]] const void* address) {
#ifdef SCINTRAY_THREAD_SANITIZER
  __tsan_release(const_cast<void*>(address));
#endif
}

inline void happens_after([[maybe_unused]] const void* address) {
#ifdef SCINTRAY_THREAD_SANITIZER
  __tsan_acquire(const_cast<void*>(address));
#endif
}

}  // namespace scintray::transport
