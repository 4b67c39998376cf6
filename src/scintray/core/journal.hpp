#pragma once
/// Finished pieces of long work, kept in a file so that the work can be resumed.

#include <chrono>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace scintray::core {

/// What is done with the journal of an earlier process.
enum class JournalStart {
  refuse,   ///< that of this very work is an error, so that none is lost by mistake; others are removed
  resume,   ///< the work continues after it; that of other work is an error
  restart,  ///< it is removed
};

struct JournalSettings {
  std::filesystem::path path;
  JournalStart start = JournalStart::refuse;
  std::chrono::milliseconds sync_every{30'000};  ///< between waits until pieces are on the disk
};

/// A file of finished pieces: each has a key and bytes. Pieces are appended as they are finished, each with a
/// check sum, so that whatever ends the process, those before are there: a piece that was not written to its
/// end is dropped. Such a file is never a result. find() and add() may be called by several threads.
class Journal {
 public:
  /// Reads what there is of earlier. The file is made by the first piece.
  /// @param identity  all that the work depends on
  /// @throws InputError for a journal as the settings have it, and for a file that is none; SystemError when
  ///         it cannot be read
  Journal(JournalSettings settings, std::string identity);
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;
  /// Keeps the file.
  ~Journal();

  /// Bytes of an earlier piece; nothing when it is not there.
  std::optional<std::string> find(const std::string& key) const;
  /// Adds a piece. @throws SystemError when it cannot be written
  void add(const std::string& key, std::string_view bytes);
  /// Pieces that are there, those of this process included.
  std::size_t pieces() const;
  /// Removes the file: the result of the work is written.
  void remove();

 private:
  struct Place {
    std::uint64_t at = 0, size = 0;
  };

  bool read_earlier();
  void open_for_writing();
  void write(std::string_view bytes);

  JournalSettings settings_;
  std::string identity_;
  mutable std::mutex mutex_;
  std::map<std::string, Place, std::less<>> pieces_;
  int descriptor_ = -1;
  std::uint64_t end_ = 0;  ///< of the sound records
  std::chrono::steady_clock::time_point synced_ = std::chrono::steady_clock::now();
};

/// Numbers as they are in memory, as keys and pieces of a journal.
template <typename T>
requires std::is_arithmetic_v<T> std::string bytes_of(const std::vector<T>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T)};
}
/// Numbers from bytes; those beyond the last whole one are dropped.
template <typename T>
requires std::is_arithmetic_v<T> std::vector<T> numbers_of(std::string_view bytes) {
  std::vector<T> numbers(bytes.size() / sizeof(T));
  if (!numbers.empty()) std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(T));
  return numbers;
}

}  // namespace scintray::core
