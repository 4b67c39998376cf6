#pragma once
/// Results of a run that goes on, or was stopped, from its checkpoints.

#include <filesystem>

namespace scintray::cli {

/// A results file to read: that of a finished run, or one made of the checkpoints of a run that goes on, in a
/// temporary folder that lasts as long as this.
class ReadableResults {
 public:
  /// @param named  a results file; where there is none, but NAME.checkpoints beside it, or where this is such
  ///               a folder, what the run has finished so far, without its lists of photons and histories
  /// @throws InputError for checkpoints that are damaged, or none; SystemError when the temporary folder
  ///         cannot be written
  explicit ReadableResults(const std::filesystem::path& named);
  ReadableResults(const ReadableResults&) = delete;
  ReadableResults& operator=(const ReadableResults&) = delete;
  ~ReadableResults();

  const std::filesystem::path& path() const { return path_; }
  /// The results file that the run will write: what pages are named by.
  const std::filesystem::path& finished() const { return finished_; }

 private:
  std::filesystem::path path_, finished_;
  std::filesystem::path folder_;  ///< temporary; empty: none
};

}  // namespace scintray::cli
