#pragma once
/// Files that appear whole or not at all.

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace scintray::core {

/// How the text of a file is stored.
enum class Container {
  plain,  ///< as it is
  zlib,   ///< one zlib stream (RFC 1950), as Geant4's data from 2.2 on
};

/// A file written as a stream. It goes to a temporary file beside the target; `commit` renames it. Without
/// commit the temporary is removed, so that a half-written file is never taken for a whole one. Members throw
/// SystemError with the file's name and the reason.
class OutputFile {
 public:
  /// @param what for messages: "the report"; nothing: the file's name is enough
  OutputFile(std::filesystem::path path, Container container, const std::string& what = {});
  OutputFile(OutputFile&&) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;
  ~OutputFile();

  void write(std::string_view text);
  /// Ends the stream and waits until the disk has it, but does not rename yet.
  void finish();
  /// `finish`, and the temporary takes the name of the target.
  void commit();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Writes a file in one go. @throws SystemError as OutputFile does.
void write_whole_file(const std::filesystem::path& path, std::string_view content,
                      const std::string& what = {});

}  // namespace scintray::core
