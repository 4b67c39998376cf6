#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>

#include "scintray/cli/run_analysis.hpp"
#include "scintray/core/error.hpp"
#include "scintray/report/pages/html_report.hpp"
#include "scintray/report/text/result_json.hpp"
#include "scintray/report/text/text_summary.hpp"
#include "scintray/results/results.hpp"

namespace scintray::cli {

namespace {

struct ReportOptions {
  std::filesystem::path results;
  std::filesystem::path output;
  bool text = false;
  bool json = false;
};

/// Path of the page: beside the results file unless set otherwise, never the results file itself.
std::filesystem::path page_path(const ReportOptions& options) {
  auto page = options.output;
  if (page.empty()) page = std::filesystem::path(options.results).replace_extension(".html");
  std::error_code ignored;
  if (page == options.results || std::filesystem::equivalent(page, options.results, ignored))
    throw core::InputError(
        {{page.string()}, "the page would replace the results file", "name another file with --output"});
  return page;
}

void report(const ReportOptions& options) {
  const tally::RunResult run = results::read_results(options.results);
  if (options.text) {
    std::cout << report::text_summary(run, analysis_of(options.results, run));
    return;
  }
  if (options.json) {
    std::cout << report::result_json(run, analysis_of(options.results, run));
    return;
  }
  const auto page = page_path(options);
  report::write_report(page, run, analysis_of(options.results, run));
  std::cout << "report   " << page.string() << "\n";
}

}  // namespace

void add_report_command(CLI::App& app) {
  auto options = std::make_shared<ReportOptions>();
  CLI::App* command = app.add_subcommand("report", "Write the HTML page of a results file");
  command->add_option("RESULT", options->results, "results file (HDF5) of `scintray run`")->required();
  command->add_option("-o,--output", options->output, "page (default: RESULT with .html)");
  command->add_flag("--text", options->text, "print the summary instead of writing a page");
  command->add_flag("--json", options->json, "print the numbers as JSON instead of writing a page")
      ->excludes("--text");
  command->callback([options] { report(*options); });
}

}  // namespace scintray::cli
