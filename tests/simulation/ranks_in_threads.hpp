#pragma once
/// Ranks of a run as threads of a test.

#include <doctest/doctest.h>

#include <array>
#include <atomic>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "scintray/simulation/ranks.hpp"
#include "scintray/simulation/simulation.hpp"

namespace scintray::test {

/// Messages between threads that stand for processes.
class Exchange {
 public:
  explicit Exchange(int size) : boxes_(static_cast<std::size_t>(size)) {}
  int size() const { return static_cast<int>(boxes_.size()); }

  void put(int to, simulation::Ranks::Message message) {
    const std::lock_guard lock(mutex_);
    boxes_[static_cast<std::size_t>(to)].push_back(std::move(message));
  }
  std::optional<simulation::Ranks::Message> take(int of) {
    const std::lock_guard lock(mutex_);
    auto& box = boxes_[static_cast<std::size_t>(of)];
    if (box.empty()) return std::nullopt;
    simulation::Ranks::Message message = std::move(box.front());
    box.pop_front();
    return message;
  }

 private:
  std::mutex mutex_;
  std::vector<std::deque<simulation::Ranks::Message>> boxes_;
};

class ThreadRanks : public simulation::Ranks {
 public:
  ThreadRanks(Exchange& exchange, int rank) : exchange_(exchange), rank_(rank) {}
  int rank() const override { return rank_; }
  int size() const override { return exchange_.size(); }
  void send(int to, std::string bytes) override { exchange_.put(to, {rank_, std::move(bytes)}); }
  std::optional<Message> receive() override { return exchange_.take(rank_); }
  void close() override { closed = true; }
  std::chrono::milliseconds patience() const override { return silence; }

  bool closed = false;
  std::chrono::milliseconds silence = std::chrono::minutes(1);

 private:
  Exchange& exchange_;
  int rank_;
};

/// The simulation of each rank: the same, unless a test makes one differ.
using MakeSimulation = std::function<simulation::Simulation(int rank)>;

/// Runs all ranks, each in a thread; an exception of rank 0 is thrown here.
inline void run_ranks(int count, const MakeSimulation& make, simulation::ResultSink& sink,
                      simulation::SimulationHooks hooks = {}) {
  Exchange exchange(count);
  std::vector<std::thread> others;
  std::atomic<int> closed{0};
  for (int rank = 1; rank < count; ++rank)
    others.emplace_back([&, rank] {
      ThreadRanks ranks(exchange, rank);
      simulation::run_part(ranks, [&] { make(rank).serve(ranks); });
      closed += ranks.closed ? 1 : 0;
    });
  ThreadRanks ranks(exchange, 0);
  hooks.ranks = &ranks;
  std::exception_ptr failure;
  try {
    simulation::run_part(ranks, [&] { make(0).run_all(sink, hooks); });
  } catch (...) {
    failure = std::current_exception();
  }
  for (std::thread& other : others) other.join();
  CHECK(closed == count - 1);
  CHECK(ranks.closed);
  if (failure) std::rethrow_exception(failure);
}

}  // namespace scintray::test
