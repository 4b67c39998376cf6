#pragma once
/// Results of a run in progress, or of one that was stopped, from its checkpoints.

#include <filesystem>

namespace scintray::cli {

/// A results file to read: that of a finished run, or one made from the checkpoints of a run in progress, in
/// a temporary folder with the lifetime of this object.
class ReadableResults {
 public:
  /// @param named  a results file; where there is none but a folder NAME.checkpoints beside it, or where this
  ///               is such a folder, the finished part of the run, without its photon lists and histories
  /// @throws InputError for damaged or missing checkpoints; SystemError when the temporary folder
  ///         cannot be written
  explicit ReadableResults(const std::filesystem::path& named);
  ReadableResults(const ReadableResults&) = delete;
  ReadableResults& operator=(const ReadableResults&) = delete;
  ~ReadableResults();

  const std::filesystem::path& path() const { return path_; }
  /// The results file that the run will write, after which pages are named.
  const std::filesystem::path& finished() const { return finished_; }

 private:
  std::filesystem::path path_, finished_;
  std::filesystem::path folder_;  ///< temporary; empty: none
};

}  // namespace scintray::cli
