#pragma once
/// A file that other programs read, written as a stream and put in place when it is whole.

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string_view>

namespace scintray {

/// How the text of a file is stored.
enum class Container {
  plain,  ///< as it is
  zlib,   ///< one zlib stream (RFC 1950), as Geant4's data from 2.2 on
};

/// Text goes to a temporary file beside the target; `commit` renames it. Without commit the temporary is
/// removed, so that a half-written file is never taken for a whole one. Members throw SystemError with the
/// file's name and the reason.
class OutputFile {
 public:
  OutputFile(std::filesystem::path path, Container container);
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

}  // namespace scintray
