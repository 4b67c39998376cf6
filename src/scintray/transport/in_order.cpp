#include "scintray/transport/in_order.hpp"

#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include "scintray/transport/detail/happens_before.hpp"

namespace scintray::transport::detail {

std::uint64_t work_in_order(std::uint64_t count, int threads, const std::atomic<bool>* stop,
                            const std::function<std::shared_ptr<void>(std::uint64_t)>& work,
                            const std::function<void(std::uint64_t, void*)>& collect) {
  constexpr std::size_t kPiecesPerThread = 4;
  using Result = std::shared_ptr<void>;
  std::uint64_t next = 0, done = 0;
  const auto give = [&](tbb::flow_control& control) -> std::uint64_t {
    happens_after(&next);
    if (next == count || (stop && stop->load())) {
      control.stop();
      return 0;
    }
    const std::uint64_t number = next++;
    happens_before(&next);
    return number;
  };
  const auto make = [&](std::uint64_t number) -> Result {
    happens_after(&next);
    Result result = work(number);
    happens_before(result.get());
    return result;
  };
  const auto take = [&](const Result& result) {
    happens_after(&done);
    happens_after(result.get());
    collect(done++, result.get());
    happens_before(&done);
  };
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  happens_before(&next);
  arena.execute([&] {
    tbb::parallel_pipeline(kPiecesPerThread * static_cast<std::size_t>(arena.max_concurrency()),
                           tbb::make_filter<void, std::uint64_t>(tbb::filter_mode::serial_in_order, give) &
                               tbb::make_filter<std::uint64_t, Result>(tbb::filter_mode::parallel, make) &
                               tbb::make_filter<Result, void>(tbb::filter_mode::serial_in_order, take));
  });
  happens_after(&done);
  return done;
}

}  // namespace scintray::transport::detail
