#pragma once
/// Files that are written completely or not at all.

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace scintray::core {

/// Encoding of a text file on disk.
enum class Container {
  plain,  ///< as it is
  zlib,   ///< one zlib stream (RFC 1950), as Geant4's data from 2.2 on
};

/// Throws InputError when `path` exists and may not be replaced by a file that begins with `content`: what is
/// no regular file (a folder, a device, a pipe), and a file of another kind, as HDF5, TOML, HTML, SVG, a
/// height map (.gsf), glTF and all others, known by their first bytes. An empty file may become anything.
void require_replaceable(const std::filesystem::path& path, std::string_view content);

/// A file written as a stream to a temporary file beside the target; `commit` renames it. Without a commit
/// the temporary file is removed, so that a partly written file is never taken for a complete one. Members
/// throw SystemError with the file's name and the reason; the constructor also as require_replaceable, for
/// content of no special kind.
class OutputFile {
 public:
  /// @param what name of the content in messages, such as "the report"; may be empty
  /// @param head  beginning of the content, which decides what it may replace
  OutputFile(std::filesystem::path path, Container container, const std::string& what = {},
             std::string_view head = {});
  OutputFile(OutputFile&&) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;
  ~OutputFile();

  void write(std::string_view text);
  /// Ends the stream and waits until it is on the disk, without renaming it yet.
  void finish();
  /// `finish`, then renames the temporary file to the target and waits until that is on the disk, too.
  void commit();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Waits until the names in the folder of a file are on the disk, so that they survive a loss of power. Does
/// nothing where the system cannot.
void sync_folder_of(const std::filesystem::path& file);

/// Writes a whole file. @throws SystemError as OutputFile does, and InputError as require_replaceable
void write_whole_file(const std::filesystem::path& path, std::string_view content,
                      const std::string& what = {});

}  // namespace scintray::core
