#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>

#include "scintray/cli/json_answer.hpp"
#include "scintray/cli/progress.hpp"
#include "scintray/config/toml_reader.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/output_file.hpp"
#include "scintray/report/pages/event_section.hpp"
#include "scintray/report/text/result_json.hpp"
#include "scintray/report/text/sweep_view.hpp"
#include "scintray/results/results.hpp"
#include "scintray/scene_file/analysis.hpp"
#include "scintray/scene_file/readout.hpp"
#include "scintray/simulation/analyze_results.hpp"

namespace scintray::cli {

namespace {

struct AnalyzeOptions {
  std::filesystem::path results, settings, page, readout, output;
  bool json = false;
};

/// The result to analyze, with the electronics applied again where requested.
std::filesystem::path result_to_analyze(const AnalyzeOptions& options) {
  if (options.readout.empty() != options.output.empty())
    throw CLI::ValidationError("--readout",
                               "other electronics write another result: use --readout FILE and "
                               "--output RESULT together");
  if (options.readout.empty()) return options.results;
  const detector::ReadoutSpec readout =
      scene_file::readout_of_text(config::read_text_file(options.readout), options.readout.string());
  with_progress("applying the electronics", [&] {
    simulation::rerun_readout(options.results, results::read_results(options.results), readout,
                              options.output);
  });
  return options.output;
}

void analyze(const AnalyzeOptions& options) {
  const JsonAnswer answer(options.json);
  const std::filesystem::path results = result_to_analyze(options);
  const tally::RunResult run =
      with_progress("reading " + results.string(), [&] { return results::read_results(results); });
  const scene_file::AnalysisSpec settings =
      options.settings.empty()
          ? scene_file::analysis_of_text(run.header.scene_text, run.header.scene_file)
          : scene_file::analysis_of_text(config::read_text_file(options.settings), options.settings.string());
  const std::vector<analysis::EventAnalysis> analyses = with_progress(
      "analysing the events", [&] { return simulation::analyze_results(results, run, settings); });
  if (analyses.empty())
    throw core::InputError(
        core::Problem{{results.string()},
                      "this result has no events to analyse",
                      "run a scene whose [source] is an event source (docs/gamma_sources.md)"});
  std::vector<report::PointAnalysis> points;
  for (std::size_t i = 0; i < analyses.size(); ++i) {
    points.push_back({report::point_label(run.points[i]), analyses[i], run.points[i].omitted});
    if (analyses.size() > 1) std::cout << points.back().label << "\n";
    std::cout << report::event_lines(analyses[i], run.points[i].omitted);
  }
  answer.print_text([&] {
    report::RunAnalysis all;
    all.points = analyses;
    return report::result_json(run, all);
  });
  if (!options.output.empty()) std::cout << "results  " << options.output.string() << "\n";
  if (options.page.empty()) return;
  with_progress("writing the page", [&] {
    core::write_whole_file(options.page,
                           report::event_page(run.header.title, results.string(), points, run.header.parts),
                           "the page");
  });
  std::cout << "page     " << options.page.string() << "\n";
}

}  // namespace

void add_analyze_command(CLI::App& app) {
  auto options = std::make_shared<AnalyzeOptions>();
  CLI::App* command = app.add_subcommand(
      "analyze", "Analyze the events of a result: spectra, light against depth, flood maps, timing");
  command->add_option("RESULT", options->results, "results file (HDF5) of `scintray run`")->required();
  command->add_option("--settings", options->settings,
                      "a file with [analysis] (default: that of the scene in the result)");
  command->add_option("--readout", options->readout,
                      "a file with [readout]: apply these electronics to the listed photons (photon_list), "
                      "without tracing");
  command->add_option("-o,--output", options->output, "the result with these electronics (HDF5)");
  command->add_option("--page", options->page, "write an HTML page with the plots");
  add_json_flag(*command, options->json);
  command->footer("Example: scintray analyze module.h5 --page module_events.html");
  command->callback([options] { analyze(*options); });
}

}  // namespace scintray::cli
