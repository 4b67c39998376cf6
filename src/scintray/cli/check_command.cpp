#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "scintray/cli/check.hpp"
#include "scintray/cli/interrupt.hpp"
#include "scintray/cli/scene_notes.hpp"
#include "scintray/cli/watched_surfaces.hpp"
#include "scintray/simulation/simulation.hpp"

namespace scintray::cli {

namespace {

struct CheckOptions {
  std::filesystem::path scene, picture;
  bool every_point = false;
  bool all = false;
};

void print_source(const source::LightSource& source, const scene::Scene& scene) {
  const std::vector<core::RegionId> origins = source.regions();
  std::cout << "\nsource: "
            << (source.has_energy() ? fmt::format("{} events, light", source.events())
                                    : fmt::format("{} photons", source.photons()))
            << " from \"" << scene.region_names[origins.front()] << "\"";
  if (origins.size() > 1)
    std::cout << " and " << origins.size() - 1 << " more part" << (origins.size() > 2 ? "s" : "");
  std::cout << "\n";
}

/// The scene file. One with errors is drawn as far as it can be read, before they are thrown.
scene_file::SceneFile load_or_draw(const CheckOptions& options) {
  try {
    return scene_file::SceneFile::load(options.scene);
  } catch (const core::InputError& error) {
    if (!options.picture.empty()) {
      const std::vector<contact::PlacedMesh> parts =
          placed_for_picture(scene_file::SceneFile::load_readable(options.scene));
      if (!parts.empty()) draw_scene(options.picture, parts, error.problems());
    }
    throw;
  }
}

void check_scene(const CheckOptions& options) {
  const std::filesystem::path& path = options.scene;
  if (!options.picture.empty()) expect_picture_name(options.picture);
  const scene_file::SceneFile file = load_or_draw(options);
  ProgressLine line(true);
  simulation::SimulationOptions run;
  run.surface_hooks = watched_surfaces(line);
  simulation::Simulation simulation(file, run);
  for (std::size_t point = 0; point < simulation.points(); ++point) {
    const bool shown = point == 0 || options.every_point;
    std::shared_ptr<const simulation::SimulationPoint> ready;
    try {
      ready = simulation.point(point);
    } catch (const core::InputError& error) {
      line.clear();
      if (!options.picture.empty())
        draw_scene(options.picture, placed_for_picture(file.spec(point)), error.problems());
      throw;
    }
    simulation.release(point);
    line.clear();
    if (!shown) continue;
    const scene_file::SceneSpec& spec = ready->spec();
    const scene::BuiltScene& built = *ready->built();
    const GapFindings gaps = find_gaps(*ready, options.all);
    if (point == 0 && !options.picture.empty()) draw_scene(options.picture, built.placed, gaps.warnings);
    if (file.points() > 1) {
      std::cout << (point > 0 ? "\n" : "") << "point " << point + 1 << " of " << file.points() << ":";
      for (std::size_t k = 0; k < file.sweep_keys().size(); ++k)
        std::cout << "  " << file.sweep_keys()[k] << " = " << file.parameters(point)[k];
      std::cout << "\n";
    }
    std::cout << fmt::format(
        "wavelengths in use: {:g} to {:g} nm; ambient medium: {}; contacts are {} by default{}\n",
        built.scene.low_nm, built.scene.high_nm, spec.ambient.name,
        core::word_of(scene_file::kContactKinds, spec.contacts_default),
        spec.contacts_default_given ? "" : " (not stated in the scene)");
    print_scene(built, options.all);
    print_source(ready->source(), built.scene);
    print_notes(std::cout, file, *ready);
    print_gaps(std::cout, gaps);
  }
  std::cout << "\n"
            << path.string() << ": no errors in " << file.points() << " point"
            << (file.points() == 1 ? "" : "s") << "\n";
}

}  // namespace

void add_check_command(CLI::App& app) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* command = app.add_subcommand("check", "Describe a scene, or list all its errors");
  command->add_option("SCENE", options->scene, "scene file (TOML)")->required();
  command->add_flag("--every-point", options->every_point,
                    "print every point of a sweep, not only the first");
  command->add_flag("--all", options->all, "print every part and interface on a line of its own");
  command->add_option("--picture", options->picture,
                      "draw the parts and mark the positions of problems: .glb, or .svg with three views");
  command->callback([options] {
    const InterruptGuard guard;
    check_scene(*options);
  });
}

}  // namespace scintray::cli
