#include "scintray/topography/detail/readers/formats.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <system_error>
#include <thread>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/core/input_file.hpp"

namespace scintray::topography {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMostConverted = std::uintmax_t{1} << 31;

/// A temporary folder, removed by the destructor.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    // mkdtemp replaces the six letters by ones of its own.
    std::string name = (fs::temp_directory_path() / ("scintray-" + std::string(6, 'X'))).string();
    if (!mkdtemp(name.data())) throw core::SystemError("cannot make a temporary folder " + name);
    path_ = name;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// The environment without a display, so that no window can open.
std::vector<char*> environment_without_display() {
  std::vector<char*> result;
  for (char** entry = environ; entry && *entry; ++entry)
    if (std::strncmp(*entry, "DISPLAY=", 8) != 0 && std::strncmp(*entry, "WAYLAND_DISPLAY=", 16) != 0)
      result.push_back(*entry);
  result.push_back(nullptr);
  return result;
}

/// Starts a program of PATH in a process group of its own, without output; empty when there is none.
std::optional<pid_t> start(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  std::vector<char*> environment = environment_without_display();
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  pid_t child = 0;
  const int error =
      posix_spawnp(&child, arguments[0], &files, &attributes, arguments.data(), environment.data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  if (error == 0) return child;
  if (error == ENOENT || error == EACCES) return std::nullopt;
  throw core::SystemError("cannot start " + words[0] + ": " + std::strerror(error));
}

/// The exit status once the program ends; empty when it was killed.
std::optional<int> wait_for(pid_t child, std::chrono::milliseconds time_limit) {
  const auto deadline = std::chrono::steady_clock::now() + time_limit;
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() > deadline) {
      kill(-child, SIGKILL);
      waitpid(child, &status, 0);
      return std::nullopt;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

GwyddionResult query_gwyddion(const std::filesystem::path& path, const ReadRequest& request,
                              std::chrono::milliseconds time_limit) {
  const TemporaryFolder folder;
  const fs::path converted = folder.path() / "converted.gwy";
  const auto child =
      start({"gwyddion", "--convert-to-gwy=" + converted.string(), fs::absolute(path).string()});
  if (!child) return {GwyddionAnswer::not_installed, {}};
  const auto status = wait_for(*child, time_limit);
  if (!status) return {GwyddionAnswer::timed_out, {}};
  std::error_code missing;
  const auto size = fs::file_size(converted, missing);
  if (*status != 0 || missing || size > kMostConverted) return {GwyddionAnswer::refused, {}};
  const core::InputRecord apart;  // a file of a random name is none of the run's
  const std::optional<std::string> content = core::read_whole_file(converted);
  if (!content || !is_gwy(*content)) return {GwyddionAnswer::refused, {}};
  RawMap map = parse_converted_gwy(*content, request);
  map.format = "converted by Gwyddion";
  return {GwyddionAnswer::converted, std::move(map)};
}

}  // namespace scintray::topography
