#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <functional>
#include <iostream>
#include <map>
#include <memory>

#include "scintray/cli/count_option.hpp"
#include "scintray/cli/exit_codes.hpp"
#include "scintray/cli/interrupt.hpp"
#include "scintray/cli/json_answer.hpp"
#include "scintray/cli/mpi_ranks.hpp"
#include "scintray/cli/progress.hpp"
#include "scintray/cli/run_analysis.hpp"
#include "scintray/cli/scene_notes.hpp"
#include "scintray/cli/shard_option.hpp"
#include "scintray/cli/watched_surfaces.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/file_lock.hpp"
#include "scintray/core/lane_width.hpp"
#include "scintray/core/units.hpp"
#include "scintray/report/text/result_json.hpp"
#include "scintray/simulation/results_file.hpp"
#include "scintray/simulation/simulation.hpp"

namespace scintray::cli {

namespace {

struct RunOptions {
  std::vector<std::filesystem::path> scenes;
  std::filesystem::path output;
  std::optional<int> threads, lane_width;
  std::optional<std::uint64_t> seed, photons, events;
  bool no_report = false;
  bool no_view = false;
  bool quiet = false;
  bool quick = false;
  bool json = false;
  std::optional<simulation::Shard> shard;  ///< none: the whole run
  std::string interval = "60 s";           ///< between checkpoints
  bool resume = false, restart = false, no_checkpoints = false;
  std::unique_ptr<simulation::Ranks> ranks;  ///< processes of mpirun; null: this one alone
};

/// Path of the output without -o: the results as the scene has it, else the scene's name in the working
/// folder; of a shard its number is in the name, so that shards of one run lie side by side.
std::filesystem::path output_path(const RunOptions& options, const std::filesystem::path& scene,
                                  const scene_file::SceneFile& file) {
  if (!options.output.empty()) return options.output;
  std::filesystem::path results = file.spec(0).run.output;
  if (results.empty()) results = scene.stem().string() + ".h5";
  return options.shard ? shard_path(results, *options.shard) : results;
}

/// What is wrong with a number of lanes; empty for one of this processor.
std::string problem_of_lane_width(const std::string& text) {
  std::string widths;
  for (const int width : core::lane_widths()) {
    if (text == std::to_string(width)) return {};
    widths += (widths.empty() ? "" : ", ") + std::to_string(width);
  }
  return "\"" + text + "\" is no number of lanes that this processor has: " + widths;
}

/// @throws CLI::ValidationError
std::chrono::milliseconds interval_of(const std::string& text) {
  constexpr double kNanosecondsPerMillisecond = 1e6, kMost = 1e12;
  try {
    const double ms = core::parse_quantity(text, core::Dimension::time) / kNanosecondsPerMillisecond;
    if (ms >= 0.0 && ms < kMost) return std::chrono::milliseconds(std::llround(ms));
  } catch (const core::InputError& error) {
    throw CLI::ValidationError("--checkpoint-every",
                               error.problems().front().what + "; " + error.problems().front().hint);
  }
  throw CLI::ValidationError("--checkpoint-every", "\"" + text + "\" is no time from 0 to 30 years");
}

simulation::CheckpointSettings checkpoint_settings(const RunOptions& options,
                                                   const std::filesystem::path& output) {
  simulation::CheckpointSettings settings;
  settings.folder = output.string() + ".checkpoints";
  settings.every = interval_of(options.interval);
  if (options.resume) settings.resume = simulation::Resume::resume;
  if (options.restart) settings.resume = simulation::Resume::restart;
  return settings;
}

simulation::SimulationOptions simulation_options(const RunOptions& options, ProgressLine& line) {
  simulation::SimulationOptions result;
  result.threads = options.threads;
  result.lane_width = options.lane_width;
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
    const std::string error = p.error.empty() ? "" : "  " + p.error;
    line.show(fmt::format("point {}/{}{}", p.point + 1, p.points, error), static_cast<double>(p.done),
              static_cast<double>(p.total), p.thing);
  };
  return hooks;
}

/// Prints the findings of `scintray check` on the scene's first point to standard error.
void say_before_tracing(simulation::Simulation& simulation, const scene_file::SceneFile& file,
                        ProgressLine& line) {
  const std::shared_ptr<const simulation::SimulationPoint> first = simulation.point(0);
  const GapFindings gaps = find_gaps(*first);
  line.clear();
  print_notes(std::cerr, file, *first);
  print_gaps(std::cerr, gaps);
}

/// Ends a command whose run was stopped.
[[noreturn]] void end_stopped(const std::string& what, bool can_resume) {
  std::cerr << "stopped: " << what << (can_resume ? "; --resume goes on from here" : "") << "\n";
  throw CLI::RuntimeError(kInterrupted);
}

/// Traces into a sink, with checkpoints. Finished blocks survive a failure of the system, such as a full
/// disk.
tally::RunResult trace(const RunOptions& options, simulation::Simulation& simulation,
                       simulation::ResultSink& sink, const std::filesystem::path& output,
                       ProgressLine& line) {
  simulation::Checkpoints checkpoints(checkpoint_settings(options, output));
  simulation::SimulationHooks hooks = simulation_hooks(line);
  if (!options.no_checkpoints) hooks.checkpoints = &checkpoints;
  hooks.ranks = options.ranks.get();
  simulation.build(hooks);
  InterruptGuard::keeps_results(true);
  try {
    tally::RunResult result = simulation.run_all(sink, hooks, options.shard.value_or(simulation::Shard()));
    line.clear();
    return result;
  } catch (const core::SystemError& error) {
    line.clear();
    const auto folder = checkpoint_settings(options, output).folder;
    if (simulation::range_files(folder).empty() || !std::filesystem::exists(folder)) throw;
    throw core::SystemError(std::string(error.what()) + "\n  the blocks finished before are in " +
                            folder.string() + "; --resume goes on after them");
  }
}

/// The JSON output of a command: of one scene its value, of several a list, to which each is added as soon as
/// it has been run.
class Answers {
 public:
  explicit Answers(const RunOptions& options) : several_(options.scenes.size() > 1), answer_(options.json) {
    if (several_) answer_.print_text([] { return "[\n"; });
  }
  ~Answers() {
    if (several_) answer_.print_text([] { return "]\n"; });
  }
  Answers(const Answers&) = delete;
  Answers& operator=(const Answers&) = delete;

  void add(const std::function<std::string()>& text) {
    answer_.print_text([&] { return (first_ ? "" : ",\n") + text(); });
    first_ = false;
  }

 private:
  bool several_, first_ = true;
  JsonAnswer answer_;
};

void run_shard(const RunOptions& options, simulation::Simulation& simulation,
               const std::filesystem::path& output, ProgressLine& line, Answers& answers) {
  simulation::RangeFile file(output, *options.shard);
  const tally::RunResult result = trace(options, simulation, file, output, line);
  if (!result.partial_reason.empty()) end_stopped("there is no shard yet", !options.no_checkpoints);
  std::cout << "shard    " << output.string() << "\n";
  answers.add([&] { return Json{{"shard", output.string()}}.dump() + "\n"; });
}

void run_scene(const RunOptions& options, const std::filesystem::path& scene, Answers& answers) {
  InterruptGuard::keeps_results(false);
  const scene_file::SceneFile file = scene_file::SceneFile::load(scene);
  check_criteria(file);
  ProgressLine line(!options.quiet);
  const ActivityWatch watch(line);
  const std::filesystem::path output = output_path(options, scene, file);
  const std::optional<core::FileLock> claim = core::claim_output(output);
  simulation::Simulation simulation(file, simulation_options(options, line));
  if (!options.quiet) say_before_tracing(simulation, file, line);
  if (options.shard) return run_shard(options, simulation, output, line, answers);
  simulation::ResultsFile results(output);
  const tally::RunResult result = trace(options, simulation, results, output, line);
  const report::RunAnalysis analyses =
      show_results(output, result, {!options.quiet, !options.no_report, !options.no_view});
  answers.add([&] { return report::result_json(result, analyses); });
  if (!result.complete()) end_stopped("the results are partial and marked so", !options.no_checkpoints);
}

/// Traces the blocks assigned by rank 0, which alone prints and writes.
void serve_scene(const RunOptions& options, const std::filesystem::path& scene) {
  InterruptGuard::keeps_results(false);
  ProgressLine line(false);
  simulation::Simulation simulation(scene_file::SceneFile::load(scene), simulation_options(options, line));
  simulation::SimulationHooks hooks;
  hooks.stop = &InterruptGuard::requested();
  simulation.build(hooks);
  InterruptGuard::keeps_results(true);
  simulation.serve(*options.ranks, hooks);
}

/// A run by the processes of mpirun. @throws CLI::ValidationError for several scenes
void run_on_ranks(const RunOptions& options) {
  simulation::run_part(*options.ranks, [&] {
    if (options.scenes.size() > 1)
      throw CLI::ValidationError("SCENE", "several processes run one scene; run the scenes one at a time");
    if (options.ranks->rank() == 0) {
      Answers answers(options);
      return run_scene(options, options.scenes.front(), answers);
    }
    serve_scene(options, options.scenes.front());
  });
}

/// Throws CLI::ValidationError when two scenes would write to one results file.
void require_own_outputs(const RunOptions& options) {
  std::map<std::filesystem::path, std::filesystem::path> scenes;  // by their output
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
      ->transform(whole_count());
  command
      ->add_option("--lane-width", options->lane_width,
                   "photons propagated at once, to compare speeds: no result depends on it")
      ->check(CLI::Validator(problem_of_lane_width, "LANES"));
  command->add_option("--seed", options->seed, "seed, in place of the scene's");
  command->add_option("--photons", options->photons, "photons per point, in place of the scene's")
      ->transform(whole_count());
  command->add_option("--events", options->events, "events per point, in place of the scene's")
      ->transform(whole_count());
  command->add_flag("--quick", options->quick,
                    "take the scene's quick_events or quick_photons: fewer, for a test");
  add_shard_option(*command, options->shard);
  CLI::Option* resume = command->add_flag("--resume", options->resume,
                                          "go on after the checkpoints of a run that was stopped or killed");
  CLI::Option* restart =
      command->add_flag("--restart", options->restart, "remove checkpoints of before, and begin anew");
  CLI::Option* never = command->add_flag("--no-checkpoints", options->no_checkpoints,
                                         "keep nothing of a run that is killed, and write less");
  resume->excludes(restart)->excludes(never);
  command->add_option("--checkpoint-every", options->interval,
                      "time between checkpoints, at least; \"0 s\": after each block (default: \"60 s\")");
  command->add_flag("--no-report", options->no_report, "do not write the HTML page");
  add_no_view_flag(*command, options->no_view);
  command->add_flag("-q,--quiet", options->quiet, "print only the path of the results");
  add_json_flag(*command, options->json);
  command->footer(
      "Examples:\n"
      "  scintray run quickstart.toml\n"
      "  scintray run scanner.toml --resume            after Ctrl-C, a crash or a full disk\n"
      "  scintray run scanner.toml --shard 17/400      one of 400 jobs; then: scintray merge *.shard\n"
      "  mpirun scintray run scanner.toml              all processes compute, and the first writes");
  command->callback([options] {
    interval_of(options->interval);
    if (options->scenes.size() > 1 && !options->output.empty())
      throw CLI::ValidationError("--output", "names one file, but several scenes are to be run");
    const InterruptGuard guard;
    options->ranks = mpi_ranks();
    if (options->ranks) return run_on_ranks(*options);
    if (options->scenes.size() > 1) require_own_outputs(*options);
    Answers answers(*options);
    for (const auto& scene : options->scenes) run_scene(*options, scene, answers);
  });
}

}  // namespace scintray::cli
