#include "scintray/cli/interrupt.hpp"

#include <unistd.h>

#include <csignal>
#include <iostream>
#include <string_view>

#include "scintray/cli/exit_codes.hpp"

namespace scintray::cli {

namespace {

// A signal handler can only use static storage.
std::atomic<bool> stop_requested{false}, has_results{false};
static_assert(std::atomic<bool>::is_always_lock_free, "needed in a signal handler");

constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};
constexpr unsigned kPatience_s = 2;

extern "C" void request_stop(int signal) {
  if (stop_requested.exchange(true)) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
  if (!has_results.load()) alarm(kPatience_s);
}

extern "C" void end_without_results(int) {
  if (has_results.load()) return;
  constexpr std::string_view kText = "\nstopped: there is no result yet\n";
  if (::write(STDERR_FILENO, kText.data(), kText.size()) < 0) _exit(kInterrupted);
  _exit(kInterrupted);
}

}  // namespace

InterruptGuard::InterruptGuard() {
  stop_requested.store(false);
  has_results.store(false);
  for (const int signal : kSignals) std::signal(signal, request_stop);
  std::signal(SIGALRM, end_without_results);
  std::signal(SIGPIPE, SIG_IGN);
}

InterruptGuard::~InterruptGuard() {
  std::cout.flush();  // while a pipe that nobody reads does not end the program
  for (const int signal : kSignals) std::signal(signal, SIG_DFL);
  alarm(0);
  std::signal(SIGALRM, SIG_DFL);
  std::signal(SIGPIPE, SIG_DFL);
}

const std::atomic<bool>& InterruptGuard::requested() { return stop_requested; }

void InterruptGuard::keeps_results(bool keeps) { has_results.store(keeps); }

}  // namespace scintray::cli
