#pragma once
/// Block ranges that the ranks of a run trace, and the messages about them.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/simulation/ranks.hpp"
#include "scintray/simulation/result_sink.hpp"

namespace scintray::simulation::detail {

/// Blocks of a point that one rank is to trace.
struct RankJob {
  std::uint64_t number = 0;  ///< in the order of points and blocks, from 0
  std::uint64_t point = 0;
  tally::BlockRange blocks;
};

struct RankResult {
  std::uint64_t number = 0;  ///< of the job
  std::uint64_t last = 0;    ///< one past the last block traced: that of the job, unless the rank was stopped
  double seconds = 0.0;
  std::string records;  ///< of the blocks traced, as in a file of block ranges
};

/// Traces a job; ends early when `stop` is set.
using TraceJob = std::function<RankResult(const RankJob&, const std::atomic<bool>& stop)>;

/// Thread that traces jobs one after the other, while its owner exchanges messages.
class RankWorker {
 public:
  RankWorker() : thread_([this] { work(); }) {}
  RankWorker(const RankWorker&) = delete;
  RankWorker& operator=(const RankWorker&) = delete;
  /// Stops the present job and drops the others.
  ~RankWorker();

  void add(const RankJob& job, TraceJob trace);
  /// The next result; nothing when there is none within `patience`. Rethrows what a job has thrown.
  std::optional<RankResult> take(std::chrono::milliseconds patience);
  /// Ends the present job after the blocks under way; jobs after it have no blocks.
  void stop() { stop_ = true; }

 private:
  void work();

  std::mutex mutex_;
  std::condition_variable wake_worker_, wake_owner_;
  std::deque<std::pair<RankJob, TraceJob>> jobs_;
  std::deque<RankResult> results_;
  std::exception_ptr failure_;
  bool leave_ = false;
  std::atomic<bool> stop_{false};
  std::thread thread_;  ///< last: it uses all of the above
};

/// Kinds of messages; the first byte of each.
enum class MessageKind : std::uint8_t {
  ready,   ///< to rank 0: the scene is built. RankReady
  job,     ///< from rank 0: RankJob
  result,  ///< to rank 0: RankResult
  stop,    ///< from rank 0: the blocks under way are finished, and no more begun. To it: so a signal requests
  failed,  ///< to rank 0: RankFailure
  end,     ///< from rank 0: the last message
  ended,   ///< to rank 0: the last message
  alive,   ///< to rank 0, now and then while jobs are under way: this rank still exchanges messages
};

/// First message of a rank.
struct RankReady {
  std::uint32_t threads = 1;
  RunOutline run;
};

/// An exception of a rank.
struct RankFailure {
  enum class Kind : std::uint8_t { input, system, cancelled, defect };
  Kind kind = Kind::defect;
  std::vector<core::Problem> problems;  ///< of an InputError
  std::string text;                     ///< of others

  /// Of the exception in flight. @pre within a catch clause
  static RankFailure current();
  /// Throws it as an exception of the same type, which names the rank.
  [[noreturn]] void rethrow(int rank) const;
};

std::string message(MessageKind kind);
std::string message(const RankReady& ready);
std::string message(const RankJob& job);
std::string message(const RankResult& result);
std::string message(const RankFailure& failure);

/// Kind of a message. @throws InternalError for one that no rank of this version sends, as read_message
MessageKind kind_of(const std::string& bytes);
void read_message(const std::string& bytes, RankReady& ready);
void read_message(const std::string& bytes, RankJob& job);
void read_message(const std::string& bytes, RankResult& result);
void read_message(const std::string& bytes, RankFailure& failure);

}  // namespace scintray::simulation::detail
