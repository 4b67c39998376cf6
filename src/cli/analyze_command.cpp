#include "scintray/cli/analyze_command.hpp"

#include <filesystem>
#include <iostream>
#include <memory>

#include "scintray/core/error.hpp"
#include "scintray/core/output_file.hpp"
#include "scintray/io/results.hpp"
#include "scintray/report/event_section.hpp"
#include "scintray/report/sweep_view.hpp"
#include "scintray/scene/read_analysis.hpp"
#include "scintray/scene/read_readout.hpp"
#include "scintray/scene/toml_reader.hpp"
#include "scintray/simulation/read_out_again.hpp"
#include "scintray/simulation/study_results.hpp"

namespace scintray::cli {

namespace {

struct AnalyzeOptions {
  std::filesystem::path results, settings, page, readout, output;
};

/// Makes the electronics again where that is wanted; the result to study.
std::filesystem::path result_to_study(const AnalyzeOptions& options) {
  if (options.readout.empty() != options.output.empty())
    throw CLI::ValidationError("--readout",
                               "other electronics make another result: give --readout FILE and "
                               "--output RESULT together");
  if (options.readout.empty()) return options.results;
  const ReadoutSpec readout = readout_of_text(read_text_file(options.readout), options.readout.string());
  read_out_again(options.results, read_results(options.results), readout, options.output);
  return options.output;
}

void analyze(const AnalyzeOptions& options) {
  const std::filesystem::path results = result_to_study(options);
  const RunResult run = read_results(results);
  const AnalysisSpec settings =
      options.settings.empty()
          ? analysis_of_text(run.header.scene_text, run.header.scene_file)
          : analysis_of_text(read_text_file(options.settings), options.settings.string());
  const std::vector<EventStudy> studies = study_results(results, run, settings);
  if (studies.empty())
    throw InputError(Problem{{results.string()},
                             "this result has no events to analyse",
                             "run a scene whose [source] is one of energy (docs/gamma_sources.md)"});
  std::vector<report::PointStudy> points;
  for (std::size_t i = 0; i < studies.size(); ++i) {
    points.push_back({report::point_label(run.points[i]), studies[i]});
    if (studies.size() > 1) std::cout << points.back().label << "\n";
    std::cout << report::event_lines(studies[i]);
  }
  if (!options.output.empty()) std::cout << "results  " << options.output.string() << "\n";
  if (options.page.empty()) return;
  write_whole_file(options.page, report::event_page(run.header.title, results.string(), points), "the page");
  std::cout << "page     " << options.page.string() << "\n";
}

}  // namespace

void add_analyze_command(CLI::App& app) {
  auto options = std::make_shared<AnalyzeOptions>();
  CLI::App* command = app.add_subcommand(
      "analyze", "Study the events of a result: spectra, light against depth, flood maps, timing");
  command->add_option("RESULT", options->results, "results file (HDF5) of `scintray run`")->required();
  command->add_option("--settings", options->settings,
                      "a file with [analysis] (default: that of the scene in the result)");
  command->add_option("--readout", options->readout,
                      "a file with [readout]: make these electronics of the listed photons (photon_list), "
                      "without tracing");
  command->add_option("-o,--output", options->output, "the result with these electronics (HDF5)");
  command->add_option("--page", options->page, "write an HTML page with the plots");
  command->callback([options] { analyze(*options); });
}

}  // namespace scintray::cli
