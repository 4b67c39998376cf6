#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>

#include "scintray/cli/progress.hpp"
#include "scintray/cli/results_so_far.hpp"
#include "scintray/cli/run_analysis.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/output_file.hpp"
#include "scintray/report/pages/pages.hpp"
#include "scintray/report/text/result_json.hpp"
#include "scintray/report/text/text_summary.hpp"
#include "scintray/results/results.hpp"

namespace scintray::cli {

namespace {

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
