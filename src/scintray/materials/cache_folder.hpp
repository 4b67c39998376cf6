#pragma once
/// The folder in which surface tables are kept between runs: its files, their use and its size.

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scintray/core/file_lock.hpp"

namespace scintray::materials {

/// A file of the cache.
struct CacheFile {
  std::filesystem::path path;
  std::uint64_t bytes = 0;
  std::chrono::system_clock::time_point last_use;  ///< its time of modification
};

/// Number and size of files that were removed, and number of those that could not be.
struct RemovedFiles {
  std::size_t files = 0;
  std::uint64_t bytes = 0;
  std::size_t refused = 0;
};

/// A folder with a file per table, named by the hash of its key. Other files in it are neither counted nor
/// touched. Any number of processes may use one folder at a time; a file that is removed while another reads
/// it remains readable there (POSIX unlink).
class CacheFolder {
 public:
  explicit CacheFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Path of the file of a key: table-HASH.h5 with the first 32 digits of the key's SHA-256.
  std::filesystem::path file_of(const std::string& key) const;
  /// Makes the folder. @throws SystemError
  void make() const;
  /// The lock of whoever makes the file of a key; nothing while another holds it. @throws SystemError when
  /// there can be none
  std::optional<core::FileLock> try_lock(const std::string& key) const;
  /// Records that a file was used now, where that is permitted.
  static void mark_used(const std::filesystem::path& file);

  /// Its files, those of earlier versions of ScintRay included, the least recently used first; empty for a
  /// folder that does not exist or cannot be read.
  std::vector<CacheFile> files() const;
  /// Removes the least recently used files until the rest takes at most `limit_bytes`; `kept` is not removed.
  RemovedFiles shrink(std::uint64_t limit_bytes, const std::filesystem::path& kept) const;
  /// Removes all files that were last used before a time.
  RemovedFiles remove_before(std::chrono::system_clock::time_point time) const;

 private:
  /// Removes locks and unfinished files whose makers were killed.
  void remove_leftovers() const;

  std::filesystem::path folder_;
};

}  // namespace scintray::materials
