#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <map>
#include <memory>

#include "scintray/cli/count_option.hpp"
#include "scintray/cli/exit_codes.hpp"
#include "scintray/cli/interrupt.hpp"
#include "scintray/cli/progress.hpp"
#include "scintray/cli/run_analysis.hpp"
#include "scintray/cli/scene_notes.hpp"
#include "scintray/cli/watched_surfaces.hpp"
#include "scintray/core/error.hpp"
#include "scintray/report/text/text_summary.hpp"
#include "scintray/simulation/results_file.hpp"
#include "scintray/simulation/simulation.hpp"

namespace scintray::cli {

namespace {

struct RunOptions {
  std::vector<std::filesystem::path> scenes;
  std::filesystem::path output;
  std::optional<int> threads;
  std::optional<std::uint64_t> seed, photons, events;
  bool no_report = false;
  bool quiet = false;
  bool quick = false;
};

/// Path of the results: that of the command line, else that of the scene, else the scene's name in the
/// working folder.
std::filesystem::path output_path(const RunOptions& options, const std::filesystem::path& scene,
                                  const scene_file::SceneFile& file) {
  if (!options.output.empty()) return options.output;
  if (const auto own = file.spec(0).run.output; !own.empty()) return own;
  return scene.stem().string() + ".h5";
}

simulation::SimulationOptions simulation_options(const RunOptions& options, ProgressLine& line) {
  simulation::SimulationOptions result;
  result.threads = options.threads;
  result.seed = options.seed;
  result.photons = options.photons;
  result.events = options.events;
  result.quick = options.quick;
  result.surface_hooks = watched_surfaces(line);
  return result;
}

simulation::SimulationHooks simulation_hooks(ProgressLine& line) {
  simulation::SimulationHooks hooks;
  hooks.stop = &InterruptGuard::requested();
  hooks.progress = [&line](const simulation::SimulationProgress& p) {
    line.show(fmt::format("point {}/{}", p.point + 1, p.points), static_cast<double>(p.done),
              static_cast<double>(p.total), p.thing);
  };
  return hooks;
}

/// Prints what `scintray check` says of the scene's first point, on standard error.
void say_before_tracing(simulation::Simulation& simulation, const scene_file::SceneFile& file,
                        ProgressLine& line) {
  const std::shared_ptr<const simulation::SimulationPoint> first = simulation.point(0);
  const GapFindings gaps = find_gaps(*first);
  line.clear();
  print_notes(std::cerr, file, *first);
  print_gaps(std::cerr, gaps);
}

void run_scene(const RunOptions& options, const std::filesystem::path& scene) {
  const scene_file::SceneFile file = scene_file::SceneFile::load(scene);
  check_criteria(file);
  ProgressLine line(!options.quiet);
  const std::filesystem::path output = output_path(options, scene, file);
  simulation::Simulation simulation(file, simulation_options(options, line));
  if (!options.quiet) say_before_tracing(simulation, file, line);
  simulation::ResultsFile results(output);
  const tally::RunResult result = simulation.run_all(results, simulation_hooks(line));
  line.clear();

  const report::RunAnalysis analyses = analysis_of(output, result);
  if (!options.quiet) std::cout << report::text_summary(result, analyses);
  std::cout << "results  " << output.string() << "\n";
  if (!options.no_report) write_page(output, result, analyses);
  if (!result.complete()) {
    std::cerr << "stopped: the results are partial and marked so\n";
    throw CLI::RuntimeError(kInterrupted);
  }
}

/// Throws CLI::ValidationError when two scenes would write to one results file.
void require_own_outputs(const RunOptions& options) {
  std::map<std::filesystem::path, std::filesystem::path> scenes;  // by what they write
  for (const auto& scene : options.scenes) {
    const auto output = output_path(options, scene, scene_file::SceneFile::load(scene));
    const auto [other, is_new] = scenes.try_emplace(std::filesystem::weakly_canonical(output), scene);
    if (!is_new)
      throw CLI::ValidationError(
          "SCENE",
          fmt::format("{} and {} would both write {}; run them one at a time with --output, or state "
                      "output in their [run]",
                      other->second.string(), scene.string(), output.string()));
  }
}

}  // namespace

void add_run_command(CLI::App& app) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand("run", "Trace the photons of scenes; write results and a report");
  command->add_option("SCENE", options->scenes, "scene files (TOML)")->required();
  command->add_option("-o,--output", options->output, "results file (default: SCENE's name with .h5, here)");
  command->add_option("-t,--threads", options->threads, "number of threads (default: all cores)")
      ->check(above_zero());
  command->add_option("--seed", options->seed, "seed, in place of the scene's");
  command->add_option("--photons", options->photons, "photons per point, in place of the scene's")
      ->check(above_zero());
  command->add_option("--events", options->events, "events per point, in place of the scene's")
      ->check(above_zero());
  command->add_flag("--quick", options->quick,
                    "take the scene's quick_events or quick_photons: fewer, for a test");
  command->add_flag("--no-report", options->no_report, "do not write the HTML page");
  command->add_flag("-q,--quiet", options->quiet, "print only the path of the results");
  command->callback([options] {
    if (options->scenes.size() > 1 && !options->output.empty())
      throw CLI::ValidationError("--output", "names one file, but several scenes are to be run");
    const InterruptGuard guard;
    if (options->scenes.size() > 1) require_own_outputs(*options);
    for (const auto& scene : options->scenes) run_scene(*options, scene);
  });
}

}  // namespace scintray::cli
