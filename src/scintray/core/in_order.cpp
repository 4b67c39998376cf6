#include "scintray/core/in_order.hpp"

#include <tbb/global_control.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <optional>

#include <vector>

// The order that TBB guarantees between pieces of work, stated for the thread sanitizer: TBB's library is
// not instrumented, so that the sanitizer does not see it. Nothing is compiled without the sanitizer.

#if defined(__SANITIZE_THREAD__)
#define SCINTRAY_THREAD_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define SCINTRAY_THREAD_SANITIZER 1
#endif
#endif

#ifdef SCINTRAY_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
/// Attribute of a function that reads what TBB copied to it, before its order can be declared.
#define SCINTRAY_UNSEEN_BY_THREAD_SANITIZER __attribute__((no_sanitize_thread))
#else
#define SCINTRAY_UNSEEN_BY_THREAD_SANITIZER
#endif

namespace scintray::core::detail {

namespace {

/// Declares that all earlier operations of this thread happen before a later happens_after() on the same
/// address in any thread.
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

/// Declares it at the end of its scope.
struct Declared {
  const void* address;
  ~Declared() { happens_before(address); }
};

/// The three stages of the pipeline. Pieces under way are consecutive, so that each has a slot of its own.
class Stages {
 public:
  Stages(std::uint64_t count, std::size_t most_under_way, const std::atomic<bool>* stop,
         const std::function<std::shared_ptr<void>(std::uint64_t)>& work,
         const std::function<void(std::uint64_t, void*)>& collect)
      : count_(count), stop_(stop), work_(work), collect_(collect), slots_(most_under_way) {
    happens_before(this);
  }
  /// After all pieces, those too that have failed or were not taken because another has.
  ~Stages() {
    for (const std::shared_ptr<void>& slot : slots_) happens_after(&slot);
  }

  std::uint64_t begin_next(tbb::flow_control& control) {
    happens_after(this);
    happens_after(&begun_);
    const bool ended = begun_ == count_ || (stop_ && stop_->load());
    const std::uint64_t number = ended ? count_ : begun_++;
    if (ended) control.stop();
    happens_before(&begun_);
    return number;
  }

  std::uint64_t make(std::uint64_t number) {
    happens_after(this);
    std::shared_ptr<void>& slot = slots_[number % slots_.size()];
    happens_after(&slot);
    const Declared also_where_it_fails{&slot};
    slot = work_(number);
    return number;
  }

  void take(std::uint64_t number) {
    happens_after(&taken_);
    std::shared_ptr<void>& slot = slots_[number % slots_.size()];
    happens_after(&slot);
    collect_(number, slot.get());
    slot.reset();
    ++taken_;
    happens_before(&slot);
    happens_before(&taken_);
  }

  std::uint64_t taken() const {
    happens_after(&begun_);
    happens_after(&taken_);
    return taken_;
  }

 private:
  std::uint64_t count_, begun_ = 0, taken_ = 0;
  const std::atomic<bool>* stop_;
  const std::function<std::shared_ptr<void>(std::uint64_t)>& work_;
  const std::function<void(std::uint64_t, void*)>& collect_;
  std::vector<std::shared_ptr<void>> slots_;
};

}  // namespace

std::uint64_t work_in_order(std::uint64_t count, int threads, const std::atomic<bool>* stop,
                            const std::function<std::shared_ptr<void>(std::uint64_t)>& work,
                            const std::function<void(std::uint64_t, void*)>& collect) {
  constexpr std::size_t kPiecesPerThread = 4;
  // More threads than the machine has processors are made on request only.
  constexpr auto kThreads = tbb::global_control::max_allowed_parallelism;
  std::optional<tbb::global_control> more;
  if (const auto wanted = static_cast<std::size_t>(std::max(threads, 0));
      wanted > tbb::global_control::active_value(kThreads))
    more.emplace(kThreads, wanted);
  tbb::task_arena arena(threads > 0 ? threads : tbb::this_task_arena::max_concurrency());
  const std::size_t most_under_way = kPiecesPerThread * static_cast<std::size_t>(arena.max_concurrency());
  Stages stages(count, most_under_way, stop, work, collect);
  const auto begin_next = [&](tbb::flow_control& control)
                              SCINTRAY_UNSEEN_BY_THREAD_SANITIZER { return stages.begin_next(control); };
  const auto make = [&](std::uint64_t number)
                        SCINTRAY_UNSEEN_BY_THREAD_SANITIZER { return stages.make(number); };
  const auto take = [&](std::uint64_t number) SCINTRAY_UNSEEN_BY_THREAD_SANITIZER { stages.take(number); };
  using tbb::filter_mode;
  arena.execute([&] {
    tbb::parallel_pipeline(most_under_way,
                           tbb::make_filter<void, std::uint64_t>(filter_mode::serial_in_order, begin_next) &
                               tbb::make_filter<std::uint64_t, std::uint64_t>(filter_mode::parallel, make) &
                               tbb::make_filter<std::uint64_t, void>(filter_mode::serial_in_order, take));
  });
  return stages.taken();
}

}  // namespace scintray::core::detail
