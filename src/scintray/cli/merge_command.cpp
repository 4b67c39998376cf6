#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>

#include "scintray/cli/json_answer.hpp"
#include "scintray/cli/progress.hpp"
#include "scintray/cli/response_text.hpp"
#include "scintray/cli/run_analysis.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/file_lock.hpp"
#include "scintray/report/text/result_json.hpp"
#include "scintray/simulation/checkpoints.hpp"
#include "scintray/simulation/response.hpp"
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

/// Whether the parts are shards of a response map. @throws InputError where some are
bool are_of_map(const std::vector<std::filesystem::path>& parts) {
  const auto first = std::find_if(parts.begin(), parts.end(), simulation::is_map_shard);
  if (first == parts.end()) return false;
  const auto other = std::find_if_not(parts.begin(), parts.end(), [](const std::filesystem::path& part) {
    std::error_code error;
    return simulation::is_map_shard(part) || !std::filesystem::exists(part, error);
  });
  if (other != parts.end())
    throw core::InputError({{other->string()},
                            "this is not a shard of a response map, as " + first->string() + " is",
                            "merge the shards of a run, or those of a response map"});
  return true;
}

void merge_map(const MergeOptions& options) {
  const JsonAnswer answer(options.json);
  std::filesystem::path output = options.output;
  const auto shown = [&](const auto& work) {
    return with_progress("reading the shards", work, !options.quiet);
  };
  if (!output.empty()) simulation::check_response_path(output);
  const simulation::ResponseFile file = shown([&] { return simulation::merge_map_shards(options.parts); });
  if (output.empty()) output = std::filesystem::path(file.scene_file).stem().string() + "_map.h5";
  const std::optional<core::FileLock> claim = core::claim_output(output);
  simulation::write_response(output, file);
  if (!options.quiet) print_map(file.map);
  std::cout << "map      " << output.string() << "\n";
  answer.print([&] { return json_of_map(file.map); });
}

void merge_run(const MergeOptions& options) {
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
      "merge",
      "Make of the shards of a run, or of a response map, what one process would have made, bit for bit");
  command->add_option("PARTS", options->parts, "shards in any order, and folders of checkpoints")->required();
  command->add_option("-o,--output", options->output,
                      "results file, or response map (default: the scene's name with .h5 or _map.h5, here)");
  command->add_flag("--partial", options->partial,
                    "take what there is when parts of a run are missing; the results are marked as partial");
  command->add_flag("--no-report", options->no_report, "do not write the HTML page");
  add_no_view_flag(*command, options->no_view);
  command->add_flag("-q,--quiet", options->quiet, "print only the path of the results");
  add_json_flag(*command, options->json);
  command->footer(
      "Examples:\n"
      "  scintray merge scanner.*.shard -o scanner.h5\n"
      "  scintray merge scanner.h5.checkpoints --partial -o so_far.h5    of a run that was killed\n"
      "  scintray merge module_map.*.shard -o module_map.h5              of `scintray response build`");
  command->callback([options] { are_of_map(options->parts) ? merge_map(*options) : merge_run(*options); });
}

}  // namespace scintray::cli
