#include "scintray/core/file_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string_view>
#include <utility>

#include "scintray/core/error.hpp"

namespace scintray::core {

namespace {

/// True when the name still refers to the open file: the last holder removes the file as it releases the
/// lock, and whoever had it open before then holds the lock of a file without a name.
bool still_named(const std::filesystem::path& file, int descriptor) {
  struct stat named {
  }, held{};
  return ::stat(file.c_str(), &named) == 0 && ::fstat(descriptor, &held) == 0 &&
         named.st_ino == held.st_ino && named.st_dev == held.st_dev;
}

/// Removes ".NAME.PROCESS.unfinished" of any process.
void remove_unfinished(const std::filesystem::path& folder, const std::string& name) {
  constexpr std::string_view kEnding = ".unfinished";
  const std::string beginning = "." + name + ".";
  std::error_code error;
  std::filesystem::directory_iterator entry(folder, error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    const std::string found = entry->path().filename().string();
    if (found.size() <= beginning.size() + kEnding.size() || !found.starts_with(beginning) ||
        !found.ends_with(kEnding))
      continue;
    const std::string_view process =
        std::string_view(found).substr(beginning.size(), found.size() - beginning.size() - kEnding.size());
    std::error_code ignored;
    if (process.find_first_not_of("0123456789") == std::string_view::npos)
      std::filesystem::remove(entry->path(), ignored);
  }
}

}  // namespace

FileLock::FileLock(std::filesystem::path file, int descriptor)
    : file_(std::move(file)), descriptor_(descriptor) {}

FileLock::FileLock(FileLock&& from) noexcept
    : file_(std::move(from.file_)), descriptor_(std::exchange(from.descriptor_, -1)) {}

FileLock::~FileLock() {
  if (descriptor_ < 0) return;
  ::unlink(file_.c_str());
  ::close(descriptor_);
}

std::optional<FileLock> FileLock::try_take(const std::filesystem::path& file) {
  const auto fail = [&](int cause) {
    return SystemError(file.string() + ": cannot lock: " + std::strerror(cause));
  };
  while (true) {
    const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor < 0) throw fail(errno);
    if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
      const int cause = errno;
      ::close(descriptor);
      if (cause == EINTR) continue;
      if (cause == EWOULDBLOCK) return std::nullopt;
      throw fail(cause);
    }
    if (still_named(file, descriptor)) return FileLock(file, descriptor);
    ::close(descriptor);
  }
}

namespace {

std::filesystem::path folder_of(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : ".";
}

std::filesystem::path lock_of(const std::filesystem::path& path) {
  return folder_of(path) / ("." + path.filename().string() + ".lock");
}

}  // namespace

bool is_being_written(const std::filesystem::path& path) {
  std::error_code ignored;
  try {
    return std::filesystem::exists(lock_of(path), ignored) && !FileLock::try_take(lock_of(path));
  } catch (const SystemError&) {
    return false;
  }
}

std::optional<FileLock> claim_output(const std::filesystem::path& path) {
  try {
    if (std::optional<FileLock> taken = FileLock::try_take(lock_of(path))) {
      remove_unfinished(folder_of(path), path.filename().string());
      return taken;
    }
  } catch (const SystemError&) {
    return std::nullopt;  // that it cannot be written there is found out by who writes
  }
  throw InputError({{path.string()},
                    "another process is writing this file",
                    "wait for it, or choose another name with -o"});
}

}  // namespace scintray::core
