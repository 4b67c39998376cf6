#include "scintray/materials/cache_folder.hpp"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <string_view>

#include "scintray/core/error.hpp"
#include "scintray/core/sha256.hpp"

namespace scintray::materials {

namespace {

constexpr std::string_view kPrefix = "table-", kTable = ".h5", kLock = ".lock", kUnfinished = ".unfinished";
constexpr std::size_t kHashDigits = 32;
constexpr std::size_t kEarlierHashDigits = 16;  ///< of files that did not hold their key

bool only(std::string_view text, std::string_view characters) {
  return !text.empty() && text.find_first_not_of(characters) == std::string_view::npos;
}

/// The hash in "table-HASH" + `ending`; empty for another name.
std::string_view hash_of(std::string_view name, std::string_view ending) {
  if (name.size() < kPrefix.size() + ending.size() || !name.starts_with(kPrefix) || !name.ends_with(ending))
    return {};
  name.remove_prefix(kPrefix.size());
  name.remove_suffix(ending.size());
  const bool right_length = name.size() == kHashDigits || name.size() == kEarlierHashDigits;
  return right_length && only(name, "0123456789abcdef") ? name : std::string_view();
}

/// The hash in ".table-HASH.h5.PROCESS.unfinished", as core::h5::File names a file until it is committed;
/// and in that name within another such, which earlier versions left.
std::string_view unfinished_hash_of(std::string_view name) {
  bool unfinished = false;
  while (name.starts_with('.') && name.ends_with(kUnfinished)) {
    name.remove_prefix(1);
    name.remove_suffix(kUnfinished.size());
    const std::size_t dot = name.rfind('.');
    if (dot == std::string_view::npos || !only(name.substr(dot + 1), "0123456789")) return {};
    name = name.substr(0, dot);
    unfinished = true;
  }
  return unfinished ? hash_of(name, kTable) : std::string_view();
}

std::string file_name(std::string_view hash, std::string_view ending) {
  return std::string(kPrefix) + std::string(hash) + std::string(ending);
}

std::string hash_of_key(const std::string& key) { return core::sha256(key).substr(0, kHashDigits); }

/// Paths of all regular files in a folder.
std::vector<std::filesystem::path> regular_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> found;
  std::error_code error;
  std::filesystem::directory_iterator entry(folder, error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    std::error_code unknown;
    if (entry->symlink_status(unknown).type() == std::filesystem::file_type::regular)
      found.push_back(entry->path());
  }
  return found;
}

/// Size and time of a file; nothing when it has meanwhile been removed.
std::optional<CacheFile> read_status(const std::filesystem::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return std::nullopt;
  const auto since_epoch =
      std::chrono::seconds(status.st_mtim.tv_sec) + std::chrono::nanoseconds(status.st_mtim.tv_nsec);
  return CacheFile{path, static_cast<std::uint64_t>(status.st_size),
                   std::chrono::system_clock::time_point(
                       std::chrono::duration_cast<std::chrono::system_clock::duration>(since_epoch))};
}

void remove(const CacheFile& file, RemovedFiles& removed) {
  std::error_code error;
  if (std::filesystem::remove(file.path, error)) {
    ++removed.files;
    removed.bytes += file.bytes;
  } else if (error) {  // else another process has removed it
    ++removed.refused;
  }
}

}  // namespace

std::filesystem::path CacheFolder::file_of(const std::string& key) const {
  return folder_ / file_name(hash_of_key(key), kTable);
}

void CacheFolder::make() const {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) throw core::SystemError(folder_.string() + ": cannot make the folder: " + error.message());
}

std::optional<core::FileLock> CacheFolder::try_lock(const std::string& key) const {
  return core::FileLock::try_take(folder_ / file_name(hash_of_key(key), kLock));
}

void CacheFolder::mark_used(const std::filesystem::path& file) {
  ::utimensat(AT_FDCWD, file.c_str(), nullptr, 0);
}

std::vector<CacheFile> CacheFolder::files() const {
  std::vector<CacheFile> files;
  for (const std::filesystem::path& path : regular_files(folder_)) {
    if (hash_of(path.filename().string(), kTable).empty()) continue;
    if (std::optional<CacheFile> file = read_status(path)) files.push_back(*std::move(file));
  }
  std::sort(files.begin(), files.end(), [](const CacheFile& a, const CacheFile& b) {
    return a.last_use != b.last_use ? a.last_use < b.last_use : a.path < b.path;
  });
  return files;
}

RemovedFiles CacheFolder::shrink(std::uint64_t limit_bytes, const std::filesystem::path& kept) const {
  remove_leftovers();
  RemovedFiles removed;
  const std::vector<CacheFile> files = this->files();
  std::uint64_t total = 0;
  for (const CacheFile& file : files) total += file.bytes;
  for (const CacheFile& file : files)
    if (total - removed.bytes > limit_bytes && file.path != kept) remove(file, removed);
  return removed;
}

RemovedFiles CacheFolder::remove_before(std::chrono::system_clock::time_point time) const {
  remove_leftovers();
  RemovedFiles removed;
  for (const CacheFile& file : files())
    if (file.last_use < time) remove(file, removed);
  return removed;
}

void CacheFolder::remove_leftovers() const {
  for (const std::filesystem::path& path : regular_files(folder_)) {
    const std::string name = path.filename().string();
    const std::string_view unfinished = unfinished_hash_of(name);
    const std::string_view hash = unfinished.empty() ? hash_of(name, kLock) : unfinished;
    if (hash.empty()) continue;
    try {
      // Taken only when nobody makes this table; the lock's own file is removed as it is released.
      const std::optional<core::FileLock> lock = core::FileLock::try_take(folder_ / file_name(hash, kLock));
      std::error_code ignored;
      if (lock && !unfinished.empty()) std::filesystem::remove(path, ignored);
    } catch (const core::SystemError&) {
      return;  // without permission, or without locks, by which alone makers at work are known
    }
  }
}

}  // namespace scintray::materials
