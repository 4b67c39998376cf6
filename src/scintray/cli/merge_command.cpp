#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "scintray/cli/json_answer.hpp"
#include "scintray/cli/progress.hpp"
#include "scintray/cli/run_analysis.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/file_lock.hpp"
#include "scintray/report/text/result_json.hpp"
#include "scintray/simulation/checkpoints.hpp"
#include "scintray/simulation/results_file.hpp"

namespace scintray::cli {

namespace {

struct MergeOptions {
  std::vector<std::filesystem::path> parts;
  std::filesystem::path output;
  bool partial = false;
  bool no_report = false;
  bool no_view = false;
  bool quiet = false;
  bool json = false;
};

/// Files of all parts; a folder means the checkpoints in it.
std::vector<std::filesystem::path> files_of(const std::vector<std::filesystem::path>& parts) {
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path& part : parts) {
    const std::vector<std::filesystem::path> within = simulation::range_files(part);
    if (within.empty())
      throw core::InputError({{part.string()},
                              "there are no checkpoints in this folder",
                              "name the folder beside the output of a run, NAME.checkpoints"});
    files.insert(files.end(), within.begin(), within.end());
  }
  return files;
}

void merge(const MergeOptions& options) {
  const JsonAnswer answer(options.json);
  const std::vector<std::filesystem::path> files = files_of(options.parts);
  std::filesystem::path output = options.output;
  if (output.empty()) {
    const std::filesystem::path scene = simulation::RangeReader(files.front()).outline().header.scene_file;
    output = scene.stem().string() + ".h5";
  }
  const std::optional<core::FileLock> claim = core::claim_output(output);
  simulation::ResultsFile results(output);
  const tally::RunResult result = with_progress(
      "reading the parts", [&] { return simulation::merge_ranges(files, results, options.partial); },
      !options.quiet);
  const report::RunAnalysis analyses =
      show_results(output, result, {!options.quiet, !options.no_report, !options.no_view});
  answer.print_text([&] { return report::result_json(result, analyses); });
  if (!result.complete())
    std::cerr << "the results are partial and marked so: " << result.partial_reason << "\n";
}

}  // namespace

void add_merge_command(CLI::App& app) {
  auto options = std::make_shared<MergeOptions>();
  CLI::App* command = app.add_subcommand(
      "merge", "Make of the shards of a run the results that one process would have made, bit for bit");
  command->add_option("PARTS", options->parts, "shards in any order, and folders of checkpoints")->required();
  command->add_option("-o,--output", options->output,
                      "results file (default: the scene's name with .h5, here)");
  command->add_flag("--partial", options->partial,
                    "take what there is when parts are missing; the results are marked as partial");
  command->add_flag("--no-report", options->no_report, "do not write the HTML page");
  add_no_view_flag(*command, options->no_view);
  command->add_flag("-q,--quiet", options->quiet, "print only the path of the results");
  add_json_flag(*command, options->json);
  command->footer(
      "Examples:\n"
      "  scintray merge scanner.*.shard -o scanner.h5\n"
      "  scintray merge scanner.h5.checkpoints --partial -o so_far.h5    of a run that was killed");
  command->callback([options] { merge(*options); });
}

}  // namespace scintray::cli
