#include "scintray/core/child_process.hpp"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>

#include "scintray/core/error.hpp"

namespace scintray::core {
namespace {

std::atomic<bool> in_place = false;

/// Mapped data of the process in bytes: the sixth number of /proc/self/statm, in pages.
std::size_t data_bytes() {
  std::ifstream file("/proc/self/statm");
  std::size_t pages = 0;
  for (int field = 0; field < 6; ++field) file >> pages;
  return file ? pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) : 0;
}

void lower_limit(__rlimit_resource resource, rlim_t value) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0) return;
  limit.rlim_cur = std::min(limit.rlim_cur, value);
  setrlimit(resource, &limit);
}

/// Waits for the child, also after interruptions by signals.
template <typename Call>
auto uninterrupted(Call call) {
  auto result = call();
  while (result < 0 && errno == EINTR) result = call();
  return result;
}

[[noreturn]] void answer(int pipe_end, const std::function<std::string()>& work, std::size_t most_bytes,
                         unsigned most_seconds) {
  // The parent's signal handlers must not run in the copy.
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGINT, SIGTERM})
    std::signal(signal, SIG_DFL);
  lower_limit(RLIMIT_CORE, 0);
  lower_limit(RLIMIT_CPU, most_seconds);
  if (const std::size_t now = data_bytes(); now > 0) lower_limit(RLIMIT_DATA, now + most_bytes);
  const std::string bytes = work();
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t written =
        uninterrupted([&] { return write(pipe_end, bytes.data() + done, bytes.size() - done); });
    if (written <= 0) _exit(1);
    done += static_cast<std::size_t>(written);
  }
  _exit(0);
}

}  // namespace

ChildAnswer run_in_child(const std::function<std::string()>& work, std::size_t most_bytes,
                         unsigned most_seconds) {
  if (in_place) return {work(), {}};
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) throw SystemError(std::string("cannot make a pipe: ") + std::strerror(errno));
  const pid_t child = fork();
  if (child < 0) {
    const std::string reason = std::strerror(errno);
    for (const int end : ends) close(end);
    throw SystemError("cannot make a process: " + reason);
  }
  if (child == 0) {
    close(ends[0]);
    answer(ends[1], work, most_bytes, most_seconds);
  }
  close(ends[1]);
  ChildAnswer result;
  std::array<char, 65536> block{};
  for (;;) {
    const ssize_t got = uninterrupted([&] { return read(ends[0], block.data(), block.size()); });
    if (got <= 0) break;
    result.bytes.append(block.data(), static_cast<std::size_t>(got));
  }
  close(ends[0]);
  int status = 0;
  uninterrupted([&] { return waitpid(child, &status, 0); });
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    result.trouble = signal == SIGXCPU ? "it did not come to an end"
                                       : std::string("it crashed (") + strsignal(signal) + ")";
  } else if (WEXITSTATUS(status) != 0) {
    result.trouble = "it ended without an answer";
  }
  return result;
}

void work_in_place() { in_place = true; }

}  // namespace scintray::core
