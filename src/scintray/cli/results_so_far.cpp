#include "scintray/cli/results_so_far.hpp"

#include <cstdlib>
#include <string>

#include "scintray/core/error.hpp"
#include "scintray/core/file_lock.hpp"
#include "scintray/simulation/checkpoints.hpp"
#include "scintray/simulation/results_file.hpp"

namespace scintray::cli {

namespace {

constexpr const char* kCheckpoints = ".checkpoints";

/// A results file without lists of photons and histories, which may be long.
class ShortResults : public simulation::ResultsFile {
 public:
  using ResultsFile::ResultsFile;
  void begin(const simulation::RunOutline& run) override {
    simulation::RunOutline outline = run;
    outline.photon_list = false;
    outline.histories.reset();
    ResultsFile::begin(outline);
  }
  void photons(const std::vector<tally::DetectedPhoton>&) override {}
  void histories(const tally::PhotonHistories&, const tally::HistorySubjects&) override {}
  void point(const tally::PointResult& result, const tally::HistorySubjects*) override {
    ResultsFile::point(result, nullptr);
  }
};

/// A new folder for temporary files. @throws SystemError
std::filesystem::path temporary_folder() {
  std::string name = (std::filesystem::temp_directory_path() / ("scintray-" + std::string(6, 'X'))).string();
  if (mkdtemp(name.data()) == nullptr) throw core::SystemError("cannot make a temporary folder " + name);
  return name;
}

/// The folder of the checkpoints that a name refers to; empty for a results file.
std::filesystem::path checkpoints_of(const std::filesystem::path& named) {
  std::error_code ignored;
  if (std::filesystem::is_directory(named, ignored)) return named;
  std::filesystem::path beside = named;
  beside += kCheckpoints;
  const bool goes_on = !std::filesystem::exists(named, ignored) && !simulation::range_files(beside).empty() &&
                       std::filesystem::is_directory(beside, ignored);
  return goes_on ? beside : std::filesystem::path();
}

/// @throws InputError for a results file that another process has begun, and of which it has kept nothing
void refuse_before_first_checkpoint(const std::filesystem::path& named) {
  std::error_code ignored;
  if (std::filesystem::exists(named, ignored) || !core::is_being_written(named)) return;
  throw core::InputError(
      {{named.string()},
       "its run has begun, and there is no checkpoint yet",
       "try again later; --checkpoint-every 10s keeps what is finished more often than once "
       "a minute"});
}

}  // namespace

ReadableResults::ReadableResults(const std::filesystem::path& named) : path_(named), finished_(named) {
  const std::filesystem::path checkpoints = checkpoints_of(named);
  if (checkpoints.empty()) {
    refuse_before_first_checkpoint(named);
    return;
  }
  const std::vector<std::filesystem::path> files = simulation::range_files(checkpoints);
  if (files.empty())
    throw core::InputError(
        {{named.string()},
         "there are no checkpoints in this folder",
         "name a results file, or the folder NAME.checkpoints beside the output of a run"});
  if (checkpoints.extension() == kCheckpoints)
    finished_ = std::filesystem::path(checkpoints).replace_extension();
  folder_ = temporary_folder();
  path_ = folder_ / "so_far.h5";
  try {
    ShortResults results(path_);
    simulation::merge_ranges(files, results, true);
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
    throw;
  }
}

ReadableResults::~ReadableResults() {
  std::error_code ignored;
  if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
}

}  // namespace scintray::cli
