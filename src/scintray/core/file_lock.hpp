#pragma once
/// Locks between processes.

#include <filesystem>
#include <optional>

namespace scintray::core {

/// An exclusive lock, held by one of all processes, and of the threads of each, that take it by the same
/// file. The kernel releases it when its process ends, however it ends. The file exists while the lock is
/// held, and after a process that was killed.
class FileLock {
 public:
  /// The lock; nothing while another holds it. Throws SystemError when there can be none: in a folder without
  /// permission to write, or on a file system without locks (flock(2)).
  [[nodiscard]] static std::optional<FileLock> try_take(const std::filesystem::path& file);

  FileLock(FileLock&& from) noexcept;
  FileLock& operator=(FileLock&&) = delete;
  /// Releases the lock and removes its file.
  ~FileLock();

 private:
  FileLock(std::filesystem::path file, int descriptor);

  std::filesystem::path file_;
  int descriptor_;  ///< -1: moved from
};

/// The right of this process alone to write a file: the lock ".NAME.lock" beside it. What processes that were
/// killed have left there of their writing, ".NAME.PROCESS.unfinished" of OutputFile and h5::File, is
/// removed.
/// @return the lock; nothing on a file system without locks
/// @throws InputError when another process holds it
[[nodiscard]] std::optional<FileLock> claim_output(const std::filesystem::path& path);

/// Whether a process has claimed this output, and goes on.
bool is_being_written(const std::filesystem::path& path);

}  // namespace scintray::core
