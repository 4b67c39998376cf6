#pragma once
/// Files in memory: all that is not read as a stream, or by a library, is read by these.

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace scintray::core {

/// All bytes of a regular file; empty (nullopt) for a folder, a pipe or a device, and when it cannot be
/// opened or read. It becomes part of the thread's InputRecord.
[[nodiscard]] std::optional<std::string> read_whole_file(const std::filesystem::path& path);

/// The first bytes of such a file, `most` of them or all: what its kind is known by. It does not become part
/// of the record.
[[nodiscard]] std::optional<std::string> read_beginning(const std::filesystem::path& path, std::size_t most);

/// A file that was read: its name without its folder, and the SHA-256 of its content.
struct InputFile {
  std::string name, sha256;

  auto operator<=>(const InputFile&) const = default;
};

/// Record of the files that its thread reads while it exists: all of read_whole_file() and h5::File::open(),
/// and those that readers of formats with several files add. A file that is read again is not recorded
/// again. Records are nested: the innermost alone receives.
class InputRecord {
 public:
  InputRecord();
  ~InputRecord();
  InputRecord(const InputRecord&) = delete;
  InputRecord& operator=(const InputRecord&) = delete;

  /// Each name with each content once, sorted.
  std::vector<InputFile> files() const;

  /// Adds a file to the thread's record, where there is one.
  static void add(const std::filesystem::path& path, std::string_view content);
  /// The same by its content on disk. A file that cannot be read is left out.
  static void add(const std::filesystem::path& path);

 private:
  std::map<std::filesystem::path, std::string> hashes_;
  InputRecord* outer_;
};

}  // namespace scintray::core
