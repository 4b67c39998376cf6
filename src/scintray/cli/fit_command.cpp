#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "scintray/cli/count_option.hpp"
#include "scintray/cli/exit_codes.hpp"
#include "scintray/cli/interrupt.hpp"
#include "scintray/cli/json_answer.hpp"
#include "scintray/cli/resume_options.hpp"
#include "scintray/cli/watched_surfaces.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/file_lock.hpp"
#include "scintray/report/pages/page.hpp"
#include "scintray/report/pages/pages.hpp"
#include "scintray/report/text/fit_text.hpp"
#include "scintray/report/text/result_json.hpp"
#include "scintray/simulation/fit.hpp"

namespace scintray::cli {

namespace {

struct FitOptions {
  std::filesystem::path scene, output, page;
  std::optional<int> threads;
  std::optional<std::uint64_t> seed, photons, events;
  ResumeOptions resume;
  bool quiet = false;
  bool json = false;
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
    InterruptGuard::keeps_results(true);
    line.show("curve", static_cast<double>(done), static_cast<double>(of), "");
    if (done >= of) line.restart();
  };
  return result;
}

const char* end_word(analysis::FitEnd end) {
  return end == analysis::FitEnd::converged       ? "converged"
         : end == analysis::FitEnd::not_converged ? "not_converged"
                                                  : "stopped";
}

Json fit_json(const analysis::FitRecord& record) {
  Json parameters = Json::array(), curve = Json::array();
  for (std::size_t i = 0; i < record.fit.parameters.size(); ++i) {
    const analysis::FittedParameter& fitted = record.fit.parameters[i];
    parameters.push_back(
        {{"key", record.spec.parameters[i].path.key},
         {"unit", record.spec.parameters[i].unit},
         {"start", json_of(fitted.parameter.start)},
         {"value", json_of(fitted.value.value)},
         {"error", json_of(fitted.value.error)},
         {"monte_carlo_error", json_of(fitted.monte_carlo_error)},
         {"interval", {json_of(fitted.interval_low), json_of(fitted.interval_high)}},
         {"variable", core::word_of(scene_file::kFitVariables, record.spec.parameters[i].variable)},
         {"in_variable", json_of(fitted.variable)},
         {"determined", fitted.determined}});
  }
  for (std::size_t i = 0; i < record.fit.residual.size(); ++i)
    curve.push_back({{"at", json_of(record.measured.points[i].x)},
                     {"measured", json_of(record.measured.points[i].y)},
                     {"residual_over_error", json_of(record.fit.residual[i])}});
  return {{"end", end_word(record.fit.end)},
          {"parameters", parameters},
          {"scale", json_of(record.fit.scale)},
          {"chi_square", json_of(record.fit.goodness.chi2)},
          {"degrees_of_freedom", json_of(record.fit.goodness.degrees)},
          {"curve", curve},
          {"not_included", Json::parse(report::omissions_json(record.omitted))},
          {"warnings", record.fit.warnings}};
}

void run_fit(const FitOptions& options) {
  const JsonAnswer answer(options.json);
  const scene_file::SceneFile file = scene_file::SceneFile::load(options.scene);
  std::filesystem::path output = options.output;
  if (output.empty()) output = options.scene.stem().string() + "_fit.h5";
  simulation::check_fit_path(output);
  ProgressLine line(!options.quiet);
  const ActivityWatch watch(line);
  const std::optional<core::FileLock> claim = core::claim_output(output);
  simulation::SceneFitOptions fit = fit_options(options, line);
  fit.model.journal = journal_settings(options.resume, output);
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
  answer.print([&] { return fit_json(record); });
  if (record.fit.end == analysis::FitEnd::stopped) {
    std::cerr << "stopped: the fit is partial and marked so; --resume goes on from here\n";
    throw CLI::RuntimeError(kInterrupted);
  }
  std::error_code ignored;
  std::filesystem::remove(fit.model.journal->path, ignored);
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
      ->transform(whole_count());
  command->add_option("--events", options->events, "events at each point, in place of the scene's")
      ->transform(whole_count());
  command->add_option("--seed", options->seed, "seed, in place of the scene's");
  command->add_option("-t,--threads", options->threads, "number of threads (default: all cores)")
      ->transform(whole_count());
  command->add_flag("-q,--quiet", options->quiet, "print the result, but not the steps of the search");
  add_resume_flags(*command, options->resume);
  add_json_flag(*command, options->json);
  command->footer("Example: scintray fit fit_depth_curve.toml --photons 20000");
  command->callback([options] {
    const InterruptGuard guard;
    run_fit(*options);
  });
}

}  // namespace scintray::cli
