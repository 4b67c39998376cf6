#pragma once
/// Numbered pieces of work over threads, whose results are collected in order.

#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <type_traits>

namespace scintray::transport {

/// Calls work(number) for 0 to count - 1 on many threads, and collect(number, result) in the order of the
/// numbers, by one thread at a time. Few results wait at once, so memory stays bounded.
/// @param threads  0: all cores
/// @param stop     when set from outside, work under way is finished and no more begun; may be null
/// @return pieces collected, the first so many
template <typename Work, typename Collect>
std::uint64_t work_in_order(std::uint64_t count, int threads, const std::atomic<bool>* stop, const Work& work,
                            const Collect& collect) {
  constexpr std::size_t kPiecesPerThread = 4;
  using Result = std::shared_ptr<std::decay_t<std::invoke_result_t<const Work&, std::uint64_t>>>;
  std::uint64_t next = 0, done = 0;
  const auto give = [&](tbb::flow_control& control) -> std::uint64_t {
    if (next == count || (stop && stop->load())) {
      control.stop();
      return 0;
    }
    return next++;
  };
  const auto make = [&](std::uint64_t number) -> Result {
    return std::make_shared<typename Result::element_type>(work(number));
  };
  const auto take = [&](const Result& result) { collect(done++, *result); };
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  arena.execute([&] {
    tbb::parallel_pipeline(kPiecesPerThread * static_cast<std::size_t>(arena.max_concurrency()),
                           tbb::make_filter<void, std::uint64_t>(tbb::filter_mode::serial_in_order, give) &
                               tbb::make_filter<std::uint64_t, Result>(tbb::filter_mode::parallel, make) &
                               tbb::make_filter<Result, void>(tbb::filter_mode::serial_in_order, take));
  });
  return done;
}

}  // namespace scintray::transport
