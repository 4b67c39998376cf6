#include <CLI/CLI.hpp>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "scintray/cli/progress.hpp"
#include "scintray/cli/run_analysis.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/output_file.hpp"
#include "scintray/report/pages/pages.hpp"
#include "scintray/report/text/result_json.hpp"
#include "scintray/report/text/text_summary.hpp"
#include "scintray/results/results.hpp"
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

/// The folder of the checkpoints that a name stands for; empty for a results file.
std::filesystem::path checkpoints_of(const std::filesystem::path& named) {
  std::error_code ignored;
  if (std::filesystem::is_directory(named, ignored)) return named;
  std::filesystem::path beside = named;
  beside += kCheckpoints;
  const bool goes_on = !std::filesystem::exists(named, ignored) && !simulation::range_files(beside).empty() &&
                       std::filesystem::is_directory(beside, ignored);
  return goes_on ? beside : std::filesystem::path();
}

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

ReadableResults::ReadableResults(const std::filesystem::path& named) : path_(named), finished_(named) {
  const std::filesystem::path checkpoints = checkpoints_of(named);
  if (checkpoints.empty()) return;
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

struct ReportOptions {
  std::vector<std::filesystem::path> files;
  std::filesystem::path output;
  bool text = false;
  bool json = false;
  bool no_view = false;
};

/// Path of the page: beside the first results file unless set otherwise, never one of the results.
std::filesystem::path page_path(const ReportOptions& options) {
  auto page = options.output;
  if (page.empty())
    page = std::filesystem::path(options.files.front())
               .replace_extension(options.files.size() > 1 ? ".comparison.html" : ".html");
  std::error_code ignored;
  for (const std::filesystem::path& results : options.files)
    if (page == results || std::filesystem::equivalent(page, results, ignored))
      throw core::InputError(
          {{page.string()}, "the page would replace a results file", "name another file with --output"});
  return page;
}

tally::RunResult read_with_progress(const std::filesystem::path& file) {
  return with_progress("reading " + file.string(), [&] { return results::read_results(file); });
}

void report_one(ReportOptions options) {
  const ReadableResults readable(options.files.front());
  const std::filesystem::path& results = readable.path();
  options.files.front() = readable.finished();
  const tally::RunResult run = read_with_progress(results);
  if (options.text) {
    std::cout << report::text_summary(run, analysis_of(results, run));
    return;
  }
  if (options.json) {
    std::cout << report::result_json(run, analysis_of(results, run));
    return;
  }
  const auto page = page_path(options);
  write_page(page, {results, run}, analysis_of(results, run), !options.no_view);
}

void compare(const ReportOptions& options) {
  std::vector<report::NamedResult> compared;
  for (const std::filesystem::path& file : options.files) {
    tally::RunResult run = read_with_progress(file);
    report::RunAnalysis analyses = analysis_of(file, run);
    compared.push_back({file.stem().string(), std::move(run), std::move(analyses)});
  }
  for (std::size_t i = 0; i < compared.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (compared[i].name == compared[k].name) compared[i].name = options.files[i].string();
  if (options.json) {
    std::cout << report::comparison_json(compared);
    return;
  }
  std::cout << report::comparison_text(compared);
  if (options.text) return;
  const auto page = page_path(options);
  with_progress("writing the comparison",
                [&] { core::write_whole_file(page, report::comparison_page(compared), "the comparison"); });
  std::cout << "report   " << page.string() << "\n";
}

}  // namespace

void add_report_command(CLI::App& app) {
  auto options = std::make_shared<ReportOptions>();
  CLI::App* command = app.add_subcommand(
      "report", "Write the HTML page of a results file, or compare several, with differences in sigma");
  command
      ->add_option("RESULT", options->files,
                   "results file (HDF5) of `scintray run`, finished or going on (then what its checkpoints "
                   "have); several finished ones are compared with the first")
      ->required();
  command->add_option("-o,--output", options->output,
                      "page (default: the first RESULT with .html, or .comparison.html)");
  command->add_flag("--text", options->text, "print the summary instead of writing a page");
  command
      ->add_flag("--json", options->json,
                 "print the numbers as JSON, of several RESULT their comparison, instead of writing a page")
      ->excludes("--text");
  add_no_view_flag(*command, options->no_view);
  command->footer(
      "Examples:\n"
      "  scintray report quickstart.h5 --text\n"
      "  scintray report scanner.h5 --text             of a run that goes on: what it has so far\n"
      "  scintray report before.h5 after.h5 -o comparison.html");
  command->callback([options] { options->files.size() > 1 ? compare(*options) : report_one(*options); });
}

}  // namespace scintray::cli
