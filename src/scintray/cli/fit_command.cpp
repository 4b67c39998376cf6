#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "scintray/cli/count_option.hpp"
#include "scintray/cli/exit_codes.hpp"
#include "scintray/cli/interrupt.hpp"
#include "scintray/cli/watched_surfaces.hpp"
#include "scintray/core/error.hpp"
#include "scintray/report/pages/page.hpp"
#include "scintray/report/pages/pages.hpp"
#include "scintray/report/text/fit_text.hpp"
#include "scintray/simulation/fit.hpp"

namespace scintray::cli {

namespace {

struct FitOptions {
  std::filesystem::path scene, output, page;
  std::optional<int> threads;
  std::optional<std::uint64_t> seed, photons, events;
  bool quiet = false;
};

simulation::SceneFitOptions fit_options(const FitOptions& options, ProgressLine& line) {
  simulation::SceneFitOptions result;
  simulation::SimulationOptions& run = result.model.run;
  run.threads = options.threads;
  run.seed = options.seed;
  run.photons = options.photons;
  run.events = options.events;
  result.model.stop = &InterruptGuard::requested();
  run.surface_hooks = watched_surfaces(line);
  result.model.progress = [&line](std::uint64_t done, std::uint64_t of) {
    line.show("curve", static_cast<double>(done), static_cast<double>(of), "");
    if (done >= of) line.restart();
  };
  return result;
}

void run_fit(const FitOptions& options) {
  const scene_file::SceneFile file = scene_file::SceneFile::load(options.scene);
  std::filesystem::path output = options.output;
  if (output.empty()) output = options.scene.stem().string() + "_fit.h5";
  simulation::check_fit_path(output);
  ProgressLine line(!options.quiet);
  simulation::SceneFitOptions fit = fit_options(options, line);
  if (const auto spec = file.spec(0).fit; spec && !options.quiet)
    fit.step = [&line, spec](const analysis::CurveFitStep& step) {
      line.clear();
      std::cout << report::fit_step_text(step, spec->parameters, spec->free_scale) << std::endl;
    };
  const analysis::FitRecord record = simulation::fit_scene(file, fit);
  line.clear();
  if (record.fit.curve.empty()) {
    std::cerr << "stopped before the first curve was traced: there is nothing to write\n";
    throw CLI::RuntimeError(kInterrupted);
  }
  if (!options.quiet) std::cout << "\n";
  std::cout << report::fit_text(record);
  simulation::write_fit(output, record);
  std::cout << "results  " << output.string() << "\n";
  auto page = options.page;
  if (page.empty()) page = std::filesystem::path(output).replace_extension(".html");
  report::write_page(page, report::fit_page(record));
  std::cout << "report   " << page.string() << "\n";
  if (record.fit.end == analysis::FitEnd::stopped) {
    std::cerr << "stopped: the fit is partial and marked so\n";
    throw CLI::RuntimeError(kInterrupted);
  }
}

}  // namespace

void add_fit_command(CLI::App& app) {
  auto options = std::make_shared<FitOptions>();
  CLI::App* command =
      app.add_subcommand("fit", "Fit parameters of a scene to a measured curve, as its [fit] defines");
  command->add_option("SCENE", options->scene, "scene file (TOML) with [fit]")->required();
  command->add_option("-o,--output", options->output,
                      "results file (default: SCENE's name with _fit.h5, here)");
  command->add_option("--page", options->page, "HTML page (default: beside the results file)");
  command
      ->add_option("--photons", options->photons,
                   "photons, or rays on a surface, at each point of a curve, in place of the scene's")
      ->check(above_zero());
  command->add_option("--events", options->events, "events at each point, in place of the scene's")
      ->check(above_zero());
  command->add_option("--seed", options->seed, "seed, in place of the scene's");
  command->add_option("-t,--threads", options->threads, "number of threads (default: all cores)")
      ->check(above_zero());
  command->add_flag("-q,--quiet", options->quiet, "print the result, but not the steps of the search");
  command->callback([options] {
    const InterruptGuard guard;
    run_fit(*options);
  });
}

}  // namespace scintray::cli
