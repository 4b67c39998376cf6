#include "child_program.hpp"

#include <fcntl.h>
#include <sched.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>

#include "scintray/core/error.hpp"

extern char** environ;

namespace scintray::bench {

namespace {

/// Both ends of a pipe, closed in programs that are started, except where they are given to them.
std::array<int, 2> make_pipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw core::SystemError(std::string("cannot make a pipe: ") + std::strerror(errno));
  return ends;
}

}  // namespace

ChildProgram::ChildProgram(const std::vector<std::string>& arguments) {
  const std::array<int, 2> to = make_pipe(), from = make_pipe();
  posix_spawn_file_actions_t files;
  ::posix_spawn_file_actions_init(&files);
  ::posix_spawn_file_actions_adddup2(&files, to[0], STDIN_FILENO);
  ::posix_spawn_file_actions_adddup2(&files, from[1], STDOUT_FILENO);
  std::vector<std::string> words = arguments;
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const int failure = ::posix_spawnp(&process_, pointers.front(), &files, nullptr, pointers.data(), environ);
  ::posix_spawn_file_actions_destroy(&files);
  ::close(to[0]);
  ::close(from[1]);
  if (failure != 0) {
    ::close(to[1]);
    ::close(from[0]);
    throw core::SystemError("cannot start " + arguments.front() + ": " + std::strerror(failure));
  }
  std::signal(SIGPIPE,
              SIG_IGN);  // a program that has ended is an error of write_line, not the end of this one
  input_ = ::fdopen(to[1], "w");
  output_ = ::fdopen(from[0], "r");
}

ChildProgram::~ChildProgram() {
  std::fclose(input_);
  std::fclose(output_);
  int status = 0;
  while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
}

void ChildProgram::keep_on(int processor) {
  cpu_set_t only;
  CPU_ZERO(&only);
  CPU_SET(static_cast<std::size_t>(processor), &only);
  if (::sched_setaffinity(process_, sizeof only, &only) != 0)
    throw core::SystemError(std::string("cannot choose a processor: ") + std::strerror(errno));
}

void ChildProgram::write_line(const std::string& line) {
  if (std::fputs((line + "\n").c_str(), input_) < 0 || std::fflush(input_) != 0)
    throw core::SystemError("the program beside this one has ended");
}

std::optional<std::string> ChildProgram::read_line() {
  char* line = nullptr;
  std::size_t size = 0;
  const ssize_t length = ::getline(&line, &size, output_);
  std::optional<std::string> result;
  if (length > 0) result = std::string(line, static_cast<std::size_t>(length));
  std::free(line);
  if (result && result->back() == '\n') result->pop_back();
  return result;
}

}  // namespace scintray::bench
