#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "scintray/core/error.hpp"
#include "scintray/simulation/simulation.hpp"

namespace scintray::cli {

namespace {

struct ReplayOptions {
  std::filesystem::path scene;
  std::uint64_t event = 0, photon = 0, point = 0;
  std::optional<std::uint64_t> seed;
};

std::string describe(const scene::Scene& scene, const transport::Step& step) {
  switch (step.event) {
    case core::StepEvent::scattered:
      return "scattered in the bulk";
    case core::StepEvent::re_emitted:
      return "shifted to another wavelength";
    case core::StepEvent::reflected:
      return "reflected at " + scene.region_names[scene.interfaces[step.interface].back] + " | " +
             scene.region_names[scene.interfaces[step.interface].front];
    case core::StepEvent::transmitted: {
      const scene::Interface& i = scene.interfaces[step.interface];
      return "into " + scene.region_names[step.from_back ? i.front : i.back];
    }
    case core::StepEvent::detected:
      return "DETECTED by " + scene.parts[step.sensor_part].name;
    case core::StepEvent::not_detected:
      return "NOT DETECTED by " + scene.parts[step.sensor_part].name;
    case core::StepEvent::absorbed_in_medium:
      return "ABSORBED in " + scene.media[step.medium].medium().name;
    case core::StepEvent::absorbed_at_surface:
      return "ABSORBED at " + scene.surfaces[step.surface].name;
    case core::StepEvent::escaped:
      return "ESCAPED";
    case core::StepEvent::emitted:
    case core::StepEvent::cut_interactions:
    case core::StepEvent::cut_time:
      break;  // no steps
  }
  throw core::InternalError("unknown step");
}

void replay_photon(const ReplayOptions& options) {
  simulation::SimulationOptions run;
  run.seed = options.seed;
  simulation::Simulation simulation(scene_file::SceneFile::load(options.scene), run);
  const auto point = simulation.point(options.point);

  std::cout << fmt::format("{:>6} {:>10} {:>10} {:>10} {:>8} {:>8} {:>8} {:>10} {:>10}  event\n", "step",
                           "x mm", "y mm", "z mm", "dx", "dy", "dz", "path mm", "time ns");
  std::uint64_t number = 0;
  point->replay(
      options.event, options.photon, [&](const source::Photon& photon, const transport::Step& step) {
        const core::Vec3 &p = photon.position, &d = photon.ray.direction;
        std::cout << fmt::format(
            "{:>6} {:>10.5f} {:>10.5f} {:>10.5f} {:>8.4f} {:>8.4f} {:>8.4f} {:>10.4f} {:>10.4f}  {}\n",
            ++number, p.x(), p.y(), p.z(), d.x(), d.y(), d.z(), photon.path_mm, photon.time_ns,
            describe(point->scene(), step));
      });
}

}  // namespace

void add_replay_command(CLI::App& app) {
  auto options = std::make_shared<ReplayOptions>();
  CLI::App* command = app.add_subcommand("replay", "Trace one photon of a run again, step by step");
  command->add_option("SCENE", options->scene, "scene file (TOML)")->required();
  command->add_option("--event", options->event, "event number, as in the photon list")->required();
  command->add_option("--photon", options->photon, "photon number within the event")->required();
  command->add_option("--point", options->point, "point of the sweep, from 0");
  command->add_option("--seed", options->seed, "seed, in place of the scene's");
  command->callback([options] { replay_photon(*options); });
}

}  // namespace scintray::cli
