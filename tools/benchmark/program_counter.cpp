#include <signal.h>
#include <sys/syscall.h>
#include <time.h>
#include <ucontext.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>

#include "profile.hpp"
#include "scintray/core/error.hpp"

namespace scintray::bench {

namespace {

constexpr std::size_t kMostSamples = 100'000;
constexpr long kInterval_ns = 997'000;

// A signal handler has no argument of its own: these are the only way to it.
std::uintptr_t* sample_memory = nullptr;
std::atomic<std::size_t> sample_count = 0;

/// Program counter at which a signal interrupted its thread; 0 on other processors.
std::uintptr_t program_counter(const void* context) {
#if defined(__x86_64__)
  return static_cast<std::uintptr_t>(static_cast<const ucontext_t*>(context)->uc_mcontext.gregs[REG_RIP]);
#elif defined(__aarch64__)
  return static_cast<std::uintptr_t>(static_cast<const ucontext_t*>(context)->uc_mcontext.pc);
#else
  static_cast<void>(context);
  return 0;
#endif
}

extern "C" void take_sample(int, siginfo_t*, void* context) {
  const std::size_t number = sample_count.load(std::memory_order_relaxed);
  const std::uintptr_t counter = program_counter(context);
  if (counter == 0 || number >= kMostSamples) return;
  sample_memory[number] = counter;
  sample_count.store(number + 1, std::memory_order_relaxed);
}

/// SIGPROF in the calling thread, and nowhere else, at every interval. A timer of elapsed time: those of
/// processor time are only as fine as the system's tick, and a thread that waits for a processor is sampled
/// once, where it waited.
class SignalTimer {
 public:
  SignalTimer() {
    struct sigaction action = {};
    action.sa_sigaction = take_sample;
    action.sa_flags = SA_SIGINFO | SA_RESTART;
    ::sigaction(SIGPROF, &action, &before_);
    sigevent event = {};
    event.sigev_notify = SIGEV_THREAD_ID;
    event.sigev_signo = SIGPROF;
    event._sigev_un._tid = static_cast<pid_t>(::syscall(SYS_gettid));
    if (::timer_create(CLOCK_MONOTONIC, &event, &timer_) != 0) {
      ::sigaction(SIGPROF, &before_, nullptr);
      throw core::SystemError(std::string("cannot make a timer: ") + std::strerror(errno));
    }
    const itimerspec interval{{0, kInterval_ns}, {0, kInterval_ns}};
    ::timer_settime(timer_, 0, &interval, nullptr);
  }
  ~SignalTimer() {
    ::timer_delete(timer_);
    // A signal that is pending is delivered before the next system call returns, to the handler that then
    // holds: the former one may end the process.
    ::syscall(SYS_gettid);
    ::sigaction(SIGPROF, &before_, nullptr);
  }
  SignalTimer(const SignalTimer&) = delete;
  SignalTimer& operator=(const SignalTimer&) = delete;

 private:
  struct sigaction before_ = {};
  timer_t timer_{};
};

}  // namespace

std::vector<std::uintptr_t> sample_program_counter(const std::function<void()>& work) {
  std::vector<std::uintptr_t> samples(kMostSamples);
  sample_memory = samples.data();
  sample_count = 0;
  {
    const SignalTimer timer;
    work();
  }
  samples.resize(sample_count);
  sample_memory = nullptr;
  return samples;
}

}  // namespace scintray::bench
