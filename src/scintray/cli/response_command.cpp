#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <iostream>
#include <memory>

#include "scintray/cli/count_option.hpp"
#include "scintray/cli/exit_codes.hpp"
#include "scintray/cli/interrupt.hpp"
#include "scintray/cli/json_answer.hpp"
#include "scintray/cli/response_text.hpp"
#include "scintray/cli/resume_options.hpp"
#include "scintray/cli/run_analysis.hpp"
#include "scintray/cli/shard_option.hpp"
#include "scintray/cli/watched_surfaces.hpp"
#include "scintray/cli/word_option.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/file_lock.hpp"
#include "scintray/core/units.hpp"
#include "scintray/report/text/result_json.hpp"
#include "scintray/report/text/text_summary.hpp"
#include "scintray/simulation/response.hpp"
#include "scintray/simulation/results_file.hpp"

namespace scintray::cli {

namespace {

struct BuildOptions {
  std::filesystem::path scene, output;
  std::string pitch = "1 mm";
  std::uint32_t photons = simulation::ResponseSettings{}.photons_per_cell;
  std::uint32_t delays = simulation::ResponseSettings{}.delays_kept;
  simulation::MapDirection direction = simulation::MapDirection::automatic;
  std::uint64_t channel_photons = simulation::ResponseSettings{}.photons_per_channel;
  std::optional<int> threads;
  std::optional<std::uint64_t> seed;
  ResumeOptions resume;
  std::optional<simulation::Shard> shard;  ///< none: the whole map
  bool quiet = false;
  bool json = false;
};

struct MappedRunOptions {
  std::filesystem::path scene, map, output;
  std::optional<int> threads;
  std::optional<std::uint64_t> seed, events;
  bool no_report = false;
  bool quiet = false;
  bool json = false;
};

double pitch_of(const std::string& text) {
  try {
    const double pitch_mm = core::parse_quantity(text, core::Dimension::length);
    if (pitch_mm > 0.0) return pitch_mm;
  } catch (const core::InputError& error) {
    throw CLI::ValidationError("--pitch",
                               error.problems().front().what + "; " + error.problems().front().hint);
  }
  throw CLI::ValidationError("--pitch", "\"" + text + "\" is not above zero");
}

void build(const BuildOptions& options) {
  const JsonAnswer answer(options.json);
  simulation::MapOptions map_options;
  map_options.settings = {pitch_of(options.pitch), options.photons, options.delays, options.direction,
                          options.channel_photons};
  const std::filesystem::path output =
      options.shard ? shard_path(options.output, *options.shard) : options.output;
  if (options.shard)
    map_options.shard = {output, *options.shard};
  else
    simulation::check_response_path(output);
  const std::optional<core::FileLock> claim = core::claim_output(output);
  map_options.journal = journal_settings(options.resume, output);
  const scene_file::SceneFile scene = scene_file::SceneFile::load(options.scene);
  ProgressLine line(!options.quiet);
  const ActivityWatch watch(line);
  map_options.simulation.threads = options.threads;
  map_options.simulation.seed = options.seed;
  map_options.simulation.surface_hooks = watched_surfaces(line);
  map_options.hooks.stop = &InterruptGuard::requested();
  map_options.hooks.progress = [&line](std::uint64_t done, std::uint64_t of) {
    InterruptGuard::keeps_results(true);  // in the journal
    line.show("mapping", static_cast<double>(done), static_cast<double>(of), "cells");
  };
  const auto start = std::chrono::steady_clock::now();
  const simulation::ResponseFile file = simulation::build_map(scene, map_options);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  line.clear();
  if (!options.quiet && !file.forward_because.empty())
    std::cout << "not traced backward: " << file.forward_because << "\n";
  if (file.map.grids.empty()) {
    std::cerr << "stopped: a " << (options.shard ? "shard" : "map")
              << " requires all its cells, so none was written; --resume goes on from here\n";
    throw CLI::RuntimeError(kInterrupted);
  }
  if (!options.shard) simulation::write_response(output, file);
  std::error_code ignored;
  std::filesystem::remove(map_options.journal->path, ignored);
  if (!options.quiet && !options.shard) print_map(file.map);
  if (!options.quiet) std::cout << fmt::format("built in {:.3g} s\n", took.count());
  std::cout << (options.shard ? "shard    " : "map      ") << output.string() << "\n";
  if (options.shard) return answer.print([&] { return Json{{"shard", output.string()}}; });
  answer.print([&] { return json_of_map(file.map); });
}

void print_speed(const tally::PointResult& point) {
  std::cout << fmt::format("{:.3g} s, {:.3g} events a second\n", point.wall_seconds,
                           static_cast<double>(point.energy.events) / point.wall_seconds);
}

void run(const MappedRunOptions& options) {
  const JsonAnswer answer(options.json);
  const scene_file::SceneFile scene = scene_file::SceneFile::load(options.scene);
  ProgressLine line(!options.quiet);
  const ActivityWatch watch(line);
  simulation::SimulationOptions simulation;
  simulation.threads = options.threads;
  simulation.seed = options.seed;
  simulation.events = options.events;
  simulation.surface_hooks = watched_surfaces(line);
  simulation::SimulationHooks hooks;
  hooks.stop = &InterruptGuard::requested();
  hooks.progress = [&line](const simulation::SimulationProgress& p) {
    InterruptGuard::keeps_results(true);
    line.show("events", static_cast<double>(p.done), static_cast<double>(p.total), p.thing);
  };
  simulation::ResultsFile results(options.output);
  const tally::RunResult result = simulation::simulate_mapped(scene, options.map, results, simulation, hooks);
  line.clear();
  const report::RunAnalysis analyses = analysis_of(options.output, result);
  if (!options.quiet) {
    std::cout << report::text_summary(result, analyses);
    print_speed(result.points.front());
  }
  std::cout << "results  " << options.output.string() << "\n";
  if (!options.no_report)
    write_page(std::filesystem::path(options.output).replace_extension(".html"), {options.output, result},
               analyses);
  answer.print_text([&] { return report::result_json(result, analyses); });
  if (!result.complete()) {
    std::cerr << "stopped: the results are partial and marked so\n";
    throw CLI::RuntimeError(kInterrupted);
  }
}

void add_build(CLI::App& response) {
  auto options = std::make_shared<BuildOptions>();
  CLI::App* command = response.add_subcommand(
      "build", "Trace light from each cell of a grid over the parts that scintillate");
  command->add_option("SCENE", options->scene, "scene file (TOML)")->required();
  command->add_option("-o,--output", options->output, "the map (HDF5)")->required();
  command->add_option("--pitch", options->pitch, "largest edge of a cell (default: \"1 mm\")");
  add_word_option(
      *command, "--direction", options->direction, simulation::kMapDirections,
      "trace forward from the cells, or backward from the channels, which needs surfaces that pass "
      "light both ways alike; automatic: backward where that is so");
  command->add_option("--photons", options->photons, "photons from each cell, forward (default: 10000)")
      ->transform(whole_count());
  command
      ->add_option("--channel-photons", options->channel_photons,
                   "photons from each channel, backward (default: 200000)")
      ->transform(whole_count());
  command
      ->add_option("--delays", options->delays,
                   "limit of the delays kept of each cell and channel (default: 64)")
      ->transform(whole_count());
  command->add_option("-t,--threads", options->threads, "number of threads (default: all cores)")
      ->transform(whole_count());
  command->add_option("--seed", options->seed, "seed, in place of the scene's");
  command->add_flag("-q,--quiet", options->quiet, "print only the path of the map");
  add_resume_flags(*command, options->resume);
  add_shard_option(*command, options->shard);
  add_json_flag(*command, options->json);
  command->footer(
      "Examples:\n"
      "  scintray response build module.toml --pitch \"0.5 mm\" -o module_map.h5\n"
      "  scintray response build module.toml -o module_map.h5 --shard 17/400    one of 400 jobs;\n"
      "                                 then: scintray merge module_map.*.shard -o module_map.h5");
  command->callback([options] {
    const InterruptGuard guard;
    build(*options);
  });
}

void add_run(CLI::App& response) {
  auto options = std::make_shared<MappedRunOptions>();
  CLI::App* command =
      response.add_subcommand("run", "Simulate events from a map; write results as `scintray run` does");
  command
      ->add_option("SCENE", options->scene,
                   "scene file (TOML): the map's, but for its [source], [run] and [readout]")
      ->required();
  command->add_option("MAP", options->map, "the map (HDF5)")->required();
  command->add_option("-o,--output", options->output, "results file")->required();
  command->add_option("--events", options->events, "events, in place of the scene's")
      ->transform(whole_count());
  command->add_option("-t,--threads", options->threads, "number of threads (default: all cores)")
      ->transform(whole_count());
  command->add_option("--seed", options->seed, "seed, in place of the scene's");
  command->add_flag("--no-report", options->no_report, "do not write the HTML page");
  command->add_flag("-q,--quiet", options->quiet, "print only the path of the results");
  add_json_flag(*command, options->json);
  command->footer("Example: scintray response run module.toml module_map.h5 --events 1000000 -o module.h5");
  command->callback([options] {
    const InterruptGuard guard;
    run(*options);
  });
}

}  // namespace

void add_response_command(CLI::App& app) {
  CLI::App* response = app.add_subcommand("response", "Response maps: trace once, simulate events often");
  response->require_subcommand(1);
  response->footer(
      "Examples:\n"
      "  scintray response build module.toml -o module_map.h5\n"
      "  scintray response run module.toml module_map.h5 -o module.h5");
  add_build(*response);
  add_run(*response);
}

}  // namespace scintray::cli
