#pragma once
/// Numbered pieces of work over threads, whose results are collected in order.

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <type_traits>

namespace scintray::core {

namespace detail {

/// work_in_order() with the type of the results erased.
std::uint64_t work_in_order(std::uint64_t count, int threads, const std::atomic<bool>* stop,
                            const std::function<std::shared_ptr<void>(std::uint64_t)>& work,
                            const std::function<void(std::uint64_t, void*)>& collect);

}  // namespace detail

/// Number of pieces of work done: work(number) is called for 0 to count - 1 on many threads, and
/// collect(number, result) in the order of the numbers, by one thread at a time. Few results are held at
/// once, so that memory is bounded.
/// @param threads  0: all cores, or as many as the work has that this is called from
/// @param stop     when set from outside, work in progress is finished and no more started; may be null
/// @return number of pieces collected, from the first on
template <typename Work, typename Collect>
std::uint64_t work_in_order(std::uint64_t count, int threads, const std::atomic<bool>* stop, const Work& work,
                            const Collect& collect) {
  using Result = std::decay_t<std::invoke_result_t<const Work&, std::uint64_t>>;
  return detail::work_in_order(
      count, threads, stop,
      [&work](std::uint64_t number) -> std::shared_ptr<void> {
        return std::make_shared<Result>(work(number));
      },
      [&collect](std::uint64_t number, void* result) { collect(number, *static_cast<Result*>(result)); });
}

}  // namespace scintray::core
