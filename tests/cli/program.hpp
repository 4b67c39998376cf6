#pragma once
/// Running the program as a user does.

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "support/environment.hpp"
#include "support/shared.hpp"

namespace scintray::test {

struct Ended {
  int exit_code = -1;  ///< -1 when a signal ended it
  std::string output;  ///< standard output and standard error
  long peak_kib = 0;   ///< peak resident memory
};

/// A running `scintray ARGUMENTS` in a folder of its own.
class Program {
 public:
  /// `file_limit_bytes` above 0 makes every file that grows past it fail as on a full disk.
  Program(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
          rlim_t file_limit_bytes = 0, const std::vector<std::string>& launcher = {})
      : log_(folder / "output.txt") {
    child_ = fork();
    REQUIRE(child_ >= 0);
    if (child_ == 0) start(arguments, folder, file_limit_bytes, launcher);
  }

  void signal(int number) const { kill(child_, number); }

  /// Waits until the program handles a signal itself, by the mask of proc(5); a minute at most.
  void await_handler(int number) const {
    for (int turn = 0; turn < 60'000; ++turn) {
      std::ifstream status("/proc/" + std::to_string(child_) + "/status");
      for (std::string word; status >> word;) {
        if (word != "SigCgt:" || !(status >> word)) continue;
        if (std::stoull(word, nullptr, 16) >> (number - 1) & 1U) return;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  Ended wait() const {
    Ended ended;
    int status = 0;
    rusage usage{};
    wait4(child_, &status, 0, &usage);
    if (WIFEXITED(status)) ended.exit_code = WEXITSTATUS(status);
    ended.peak_kib = usage.ru_maxrss;
    std::ifstream stream(log_);
    std::ostringstream text;
    text << stream.rdbuf();
    ended.output = text.str();
    return ended;
  }

 private:
  [[noreturn]] void start(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                          rlim_t file_limit_bytes, const std::vector<std::string>& launcher) const {
    const int log = open(log_.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0644);
    dup2(log, STDOUT_FILENO);
    dup2(log, STDERR_FILENO);
    if (chdir(folder.c_str()) != 0) _exit(120);
    setenv("SCINTRAY_CACHE_SIZE", "0", 0);  // tables are those of this build, unless a test sets the cache
    if (file_limit_bytes > 0) {
      std::signal(SIGXFSZ, SIG_IGN);
      const rlimit limit{file_limit_bytes, file_limit_bytes};
      setrlimit(RLIMIT_FSIZE, &limit);
    }
    const std::string program = program_file().string();
    std::vector<char*> words;
    for (const std::string& word : launcher) words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(const_cast<char*>(program.c_str()));
    for (const std::string& word : arguments) words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);
    execv(words.front(), words.data());
    _exit(121);
  }

  std::filesystem::path log_;
  pid_t child_ = -1;
};

/// While it exists, programs take the surface tables that tests of this run have made, and keep theirs for
/// others.
class WithTablesOfThisRun {
  ScopedVariable place_{"SCINTRAY_CACHE", tables_of_this_run().string()},
      size_{"SCINTRAY_CACHE_SIZE", "1 GiB"};
};

inline Ended run_program(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                         rlim_t file_limit_bytes = 0) {
  return Program(arguments, folder, file_limit_bytes).wait();
}

}  // namespace scintray::test
