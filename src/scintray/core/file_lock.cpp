#include "scintray/core/file_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "scintray/core/error.hpp"

namespace scintray::core {

namespace {

/// True when the name still stands for the open file: the last holder removes the file as it releases the
/// lock, and whoever had it open before then holds the lock of a file without a name.
bool still_named(const std::filesystem::path& file, int descriptor) {
  struct stat named {
  }, held{};
  return ::stat(file.c_str(), &named) == 0 && ::fstat(descriptor, &held) == 0 &&
         named.st_ino == held.st_ino && named.st_dev == held.st_dev;
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

}  // namespace scintray::core
