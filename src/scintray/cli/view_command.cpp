#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "scintray/cli/check.hpp"
#include "scintray/cli/progress.hpp"
#include "scintray/cli/scene_notes.hpp"
#include "scintray/cli/scene_view.hpp"
#include "scintray/core/output_file.hpp"
#include "scintray/report/view/view_page.hpp"
#include "scintray/simulation/photon_paths.hpp"
#include "scintray/simulation/simulation.hpp"

namespace scintray::cli {

namespace {

struct ViewOptions {
  std::filesystem::path scene, page;
  std::uint64_t paths = 200, point = 0;
  std::optional<std::uint64_t> seed;
};

std::vector<report::ViewMark> marks_of(const std::vector<core::Problem>& problems) {
  std::vector<report::ViewMark> marks;
  for (const core::Problem& problem : problems) {
    report::ViewMark mark{problem.what, {}};
    for (const auto& [x, y, z] : problem.places_mm) mark.places.emplace_back(x, y, z);
    marks.push_back(std::move(mark));
  }
  return marks;
}

void write_view(const ViewOptions& options, report::SceneView view) {
  if (view.title.empty()) view.title = options.scene.filename().string();
  const std::filesystem::path page = options.page.empty()
                                         ? std::filesystem::path(options.scene.stem().string() + "_view.html")
                                         : options.page;
  const std::string content = report::view_page(view);
  core::write_whole_file(page, content);
  std::cout << fmt::format("{}: {} parts, {} photon paths, {:.1f} MB\n", page.string(), view.parts.size(),
                           view.paths.size(), 1e-6 * static_cast<double>(content.size()));
}

void view_scene(const ViewOptions& options) {
  simulation::SimulationOptions settings;
  settings.seed = options.seed;
  const scene_file::SceneFile file = scene_file::SceneFile::load(options.scene);
  simulation::Simulation simulation(file, settings);
  std::shared_ptr<const simulation::SimulationPoint> point;
  try {
    point = with_progress("building the scene", [&] { return simulation.point(options.point); });
  } catch (const core::InputError& error) {
    // The parts as far as they can be placed, with the problems that have a place, before these are thrown.
    const scene_file::SceneSpec spec = file.spec(options.point);
    const std::vector<contact::PlacedMesh> placed = placed_for_picture(spec);
    if (!placed.empty())
      write_view(options, {spec.title, view_parts(placed), {}, marks_of(error.problems()), {}});
    throw;
  }
  write_view(options,
             {point->spec().title,
              view_parts(point->built()->placed),
              with_progress("tracing paths", [&] { return simulation::photon_paths(*point, options.paths); }),
              marks_of(find_gaps(*point).warnings),
              {}});
}

}  // namespace

void add_view_command(CLI::App& app) {
  auto options = std::make_shared<ViewOptions>();
  CLI::App* command =
      app.add_subcommand("view", "Write a page with the scene and paths of photons in three dimensions");
  command->add_option("SCENE", options->scene, "scene file (TOML)")->required();
  command->add_option("-o,--output", options->page, "page to write (default: SCENE_view.html)");
  command->add_option("--paths", options->paths, "photons to follow (default: 200)");
  command->add_option("--point", options->point, "point of the sweep, from 0 (default: 0)");
  command->add_option("--seed", options->seed, "seed, in place of the scene's");
  command->footer("Example: scintray view quickstart.toml --paths 500");
  command->callback([options] { view_scene(*options); });
}

}  // namespace scintray::cli
