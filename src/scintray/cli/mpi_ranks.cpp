#include "scintray/cli/mpi_ranks.hpp"

#define OMPI_SKIP_MPICXX 1  // the C interface alone
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <algorithm>
#include <cstddef>
#include <iostream>
#include <list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scintray/cli/exit_codes.hpp"
#include "scintray/core/error.hpp"

namespace scintray::cli {

namespace {

/// MPI counts bytes in an int: a longer message is sent in pieces, of which the last byte states whether
/// more follow.
constexpr std::size_t kMostBytes = std::size_t{1} << 30;
constexpr int kTag = 1;
constexpr char kLast = 0, kMore = 1;

/// Throws when a function of MPI has failed.
void require(int status, const char* what) {
  if (status == MPI_SUCCESS) return;
  char text[MPI_MAX_ERROR_STRING] = {};
  int length = 0;
  MPI_Error_string(status, text, &length);
  throw core::SystemError(std::string("MPI: ") + what + ": " + text);
}

class MpiRanks : public simulation::Ranks {
 public:
  MpiRanks() {
    int provided = 0;
    require(MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided), "cannot be initialised");
    if (provided < MPI_THREAD_FUNNELED)
      throw core::SystemError("MPI: this MPI does not let other threads compute (MPI_THREAD_FUNNELED)");
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    require(MPI_Comm_rank(MPI_COMM_WORLD, &rank_), "no rank");
    require(MPI_Comm_size(MPI_COMM_WORLD, &size_), "no number of ranks");
    unfinished_.resize(static_cast<std::size_t>(size_));
  }

  ~MpiRanks() override {
    if (closed_) return;
    std::cout.flush();
    MPI_Abort(MPI_COMM_WORLD, kSystemFailure);
  }

  int rank() const override { return rank_; }
  int size() const override { return size_; }

  void send(int to, std::string bytes) override {
    release_sent();
    std::size_t at = 0;
    for (;;) {
      const std::size_t size = std::min(kMostBytes, bytes.size() - at);
      const bool whole = size == bytes.size();
      std::string piece = whole ? std::move(bytes) : bytes.substr(at, size);
      at += size;
      const bool last = whole || at == bytes.size();
      piece.push_back(last ? kLast : kMore);
      Sent& sent = sent_.emplace_back();
      sent.bytes = std::move(piece);
      require(MPI_Isend(sent.bytes.data(), static_cast<int>(sent.bytes.size()), MPI_BYTE, to, kTag,
                        MPI_COMM_WORLD, &sent.request),
              "cannot send");
      if (last) return;
    }
  }

  std::optional<Message> receive() override {
    release_sent();
    for (;;) {
      int there = 0;
      MPI_Message message{};
      MPI_Status status{};
      require(MPI_Improbe(MPI_ANY_SOURCE, kTag, MPI_COMM_WORLD, &there, &message, &status),
              "cannot look for messages");
      if (there == 0) return std::nullopt;
      int count = 0;
      require(MPI_Get_count(&status, MPI_BYTE, &count), "a message of no length");
      std::string piece(static_cast<std::size_t>(count), '\0');
      require(MPI_Mrecv(piece.data(), count, MPI_BYTE, &message, &status), "cannot receive");
      if (piece.empty()) throw core::InternalError("a message of another program between the ranks");
      const bool last = piece.back() == kLast;
      piece.pop_back();
      std::string& whole = unfinished_[static_cast<std::size_t>(status.MPI_SOURCE)];
      whole = whole.empty() ? std::move(piece) : whole + piece;
      if (last) return Message{status.MPI_SOURCE, std::exchange(whole, {})};
    }
  }

  void close() override {
    for (Sent& sent : sent_) require(MPI_Wait(&sent.request, MPI_STATUS_IGNORE), "cannot send");
    sent_.clear();
    closed_ = true;
    require(MPI_Finalize(), "cannot be ended");
  }

 private:
  struct Sent {
    std::string bytes;
    MPI_Request request = MPI_REQUEST_NULL;
  };

  /// Frees messages that have left.
  void release_sent() {
    sent_.remove_if([](Sent& sent) {
      int done = 0;
      require(MPI_Test(&sent.request, &done, MPI_STATUS_IGNORE), "cannot send");
      return done != 0;
    });
  }

  int rank_ = 0, size_ = 1;
  bool closed_ = false;
  std::list<Sent> sent_;                 ///< in transit: their addresses must not change
  std::vector<std::string> unfinished_;  ///< by rank: the pieces of a message so far
};

}  // namespace

std::unique_ptr<simulation::Ranks> mpi_ranks() {
  if (launched_processes() == 1) return nullptr;
  return std::make_unique<MpiRanks>();
}

}  // namespace scintray::cli
