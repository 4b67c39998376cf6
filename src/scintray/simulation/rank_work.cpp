#include "scintray/simulation/detail/rank_work.hpp"

#include <fmt/format.h>

#include <new>

#include "scintray/core/cancelled.hpp"
#include "scintray/core/error.hpp"
#include "scintray/simulation/detail/range_records.hpp"

namespace scintray::simulation::detail {

RankWorker::~RankWorker() {
  {
    const std::lock_guard lock(mutex_);
    leave_ = true;
    stop_ = true;
  }
  wake_worker_.notify_one();
  thread_.join();
}

void RankWorker::add(const RankJob& job, TraceJob trace) {
  {
    const std::lock_guard lock(mutex_);
    jobs_.emplace_back(job, std::move(trace));
  }
  wake_worker_.notify_one();
}

std::optional<RankResult> RankWorker::take(std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  wake_owner_.wait_for(lock, patience, [&] { return failure_ || !results_.empty(); });
  if (failure_) std::rethrow_exception(failure_);
  if (results_.empty()) return std::nullopt;
  RankResult result = std::move(results_.front());
  results_.pop_front();
  return result;
}

void RankWorker::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    wake_worker_.wait(lock, [&] { return leave_ || !jobs_.empty(); });
    if (leave_) return;
    auto [job, trace] = std::move(jobs_.front());
    jobs_.pop_front();
    lock.unlock();
    std::optional<RankResult> result;
    std::exception_ptr failure;
    try {
      result = trace(job, stop_);
    } catch (...) {
      failure = std::current_exception();
    }
    trace = nullptr;  // it holds the scene
    lock.lock();
    if (result) results_.push_back(std::move(*result));
    if (failure) failure_ = failure;
    wake_owner_.notify_one();
  }
}

RankFailure RankFailure::current() {
  try {
    throw;
  } catch (const core::InputError& error) {
    return {Kind::input, error.problems(), {}};
  } catch (const core::Cancelled& error) {
    return {Kind::cancelled, {}, error.what()};
  } catch (const core::SystemError& error) {
    return {Kind::system, {}, error.what()};
  } catch (const std::bad_alloc&) {
    return {Kind::system, {}, "out of memory"};
  } catch (const std::exception& error) {
    return {Kind::defect, {}, error.what()};
  }
}

void RankFailure::rethrow(int rank) const {
  const std::string name = fmt::format("rank {}: ", rank);
  if (kind == Kind::input) {
    std::vector<core::Problem> named = problems;
    for (core::Problem& problem : named) problem.what = name + problem.what;
    throw core::InputError(std::move(named));
  }
  if (kind == Kind::cancelled) throw core::Cancelled(text);
  if (kind == Kind::system) throw core::SystemError(name + text);
  throw core::InternalError(name + text);
}

namespace {

template <typename A>
void exchange(A& a, RankReady& v) {
  pass(a, v.threads, v.run);
}
template <typename A>
void exchange(A& a, RankJob& v) {
  pass(a, v.number, v.point, v.blocks);
}
template <typename A>
void exchange(A& a, RankResult& v) {
  pass(a, v.number, v.last, v.seconds, v.records);
}
template <typename A>
void exchange(A& a, core::Problem& v) {
  pass(a, v.where, v.what, v.hint);
}
template <typename A>
void exchange(A& a, RankFailure& v) {
  exchange(a, v.kind);
  std::uint64_t count = v.problems.size();
  pass(a, count, v.text);
  if constexpr (A::kReads) {
    if (count > 1'000'000) throw Undecodable();
    v.problems.resize(count);
  }
  for (core::Problem& problem : v.problems) exchange(a, problem);
}

template <typename T>
std::string written(MessageKind kind, const T& value) {
  Encoder encoder;
  exchange(encoder, kind);
  exchange(encoder, const_cast<T&>(value));  // an Encoder only reads it
  return std::move(encoder.bytes);
}

template <typename T>
void read(const std::string& bytes, T& value) {
  MessageKind kind{};
  try {
    Decoder decoder(bytes);
    exchange(decoder, kind);
    exchange(decoder, value);
    if (decoder.at_end()) return;
  } catch (const Undecodable&) {
  }
  throw core::InternalError(
      fmt::format("a message of kind {} between ranks that is damaged", static_cast<int>(kind)));
}

}  // namespace

std::string message(MessageKind kind) { return encoded(kind); }
std::string message(const RankReady& ready) { return written(MessageKind::ready, ready); }
std::string message(const RankJob& job) { return written(MessageKind::job, job); }
std::string message(const RankResult& result) { return written(MessageKind::result, result); }
std::string message(const RankFailure& failure) { return written(MessageKind::failed, failure); }

MessageKind kind_of(const std::string& bytes) {
  MessageKind kind{};
  try {
    Decoder decoder(bytes);
    exchange(decoder, kind);
  } catch (const Undecodable&) {
    throw core::InternalError("an empty message between ranks");
  }
  return kind;
}

void read_message(const std::string& bytes, RankReady& ready) { read(bytes, ready); }
void read_message(const std::string& bytes, RankJob& job) { read(bytes, job); }
void read_message(const std::string& bytes, RankResult& result) { read(bytes, result); }
void read_message(const std::string& bytes, RankFailure& failure) { read(bytes, failure); }

}  // namespace scintray::simulation::detail
