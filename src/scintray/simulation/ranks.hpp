#pragma once
/// Processes that compute one run together, as the ranks that mpirun starts.

#include <chrono>
#include <functional>
#include <optional>
#include <string>

namespace scintray::simulation {

/// The processes of a run and the messages between them. Rank 0 assigns block ranges and receives their
/// results; messages go between it and each of the others only. All functions are called by one thread.
class Ranks {
 public:
  struct Message {
    int from = 0;
    std::string bytes;
  };

  Ranks() = default;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;
  virtual ~Ranks() = default;

  /// Number of this process, from 0 to size() - 1.
  virtual int rank() const = 0;
  virtual int size() const = 0;
  /// Sends a message, and may return before it has arrived. Messages from one rank to another arrive in the
  /// order in which they were sent.
  /// @throws SystemError when the other rank cannot be reached
  virtual void send(int to, std::string bytes) = 0;
  /// The next message of any rank; nothing while none has arrived. @throws SystemError as send
  virtual std::optional<Message> receive() = 0;
  /// Ends the exchange, which all ranks do. Without it the destructor ends all processes.
  virtual void close() = 0;
  /// Time after which a rank that has work and sends nothing counts as hung, which ends the run. The same in
  /// all ranks.
  virtual std::chrono::milliseconds patience() const { return std::chrono::minutes(1); }
};

/// Runs the part of this process in a run, Simulation::run_all() of rank 0 and Simulation::serve() of the
/// others, with all that may fail before it, and ends the exchange. An exception of rank 0 ends the others
/// and leaves this function; one of another rank leaves run_all() of rank 0, with the number of that rank.
void run_part(Ranks& ranks, const std::function<void()>& part);

}  // namespace scintray::simulation
