#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string_view>

#include "scintray/cli/json_answer.hpp"
#include "scintray/cli/progress.hpp"
#include "scintray/core/input_file.hpp"
#include "scintray/results/results.hpp"
#include "scintray/simulation/photon_paths.hpp"
#include "scintray/simulation/simulation.hpp"

namespace scintray::cli {

namespace {

struct ReplayOptions {
  std::filesystem::path scene;
  std::uint64_t event = 0, photon = 0, point = 0;
  std::optional<std::uint64_t> seed;
  bool json = false;
};

/// True for a file that begins as HDF5 files do.
bool is_hdf5(const std::filesystem::path& path) {
  constexpr std::string_view kSignature = "\x89HDF\r\n\x1a\n";
  return core::read_beginning(path, kSignature.size()) == kSignature;
}

/// The scene of a scene file or of a results file, which also holds the seed of its run.
scene_file::SceneFile scene_of(const ReplayOptions& options, simulation::SimulationOptions& run) {
  if (!is_hdf5(options.scene)) return scene_file::SceneFile::load(options.scene);
  const tally::RunHeader header = results::read_results(options.scene).header;
  if (!run.seed) run.seed = header.seed;
  return scene_file::SceneFile::from_text(header.scene_text, header.scene_file);
}

void print_row(std::uint64_t number, const source::Photon& photon, const std::string& event) {
  const core::Vec3 p = photon.position, d = photon.ray.direction;
  std::cout << fmt::format(
      "{:>6} {:>10.5f} {:>10.5f} {:>10.5f} {:>8.4f} {:>8.4f} {:>8.4f} {:>10.4f} {:>10.4f}  {}\n", number,
      p.x(), p.y(), p.z(), d.x(), d.y(), d.z(), photon.path_mm, photon.time_ns, event);
}

Json step_json(const source::Photon& photon, const std::string& event) {
  const core::Vec3 p = photon.position, d = photon.ray.direction;
  return {{"position_mm", {p.x(), p.y(), p.z()}},
          {"direction", {d.x(), d.y(), d.z()}},
          {"path_mm", json_of(photon.path_mm)},
          {"time_ns", json_of(photon.time_ns)},
          {"wavelength_nm", json_of(photon.wavelength_nm)},
          {"event", event}};
}

void replay_photon(const ReplayOptions& options) {
  const JsonAnswer answer(options.json);
  Json steps = Json::array();
  simulation::SimulationOptions run;
  run.seed = options.seed;
  scene_file::SceneFile scene = scene_of(options, run);
  simulation::Simulation simulation(std::move(scene), run);
  const auto point = with_progress("building the scene", [&] { return simulation.point(options.point); });

  const source::Photon start = point->start(options.event, options.photon);
  std::cout << fmt::format("{:>6} {:>10} {:>10} {:>10} {:>8} {:>8} {:>8} {:>10} {:>10}  event\n", "step",
                           "x mm", "y mm", "z mm", "dx", "dy", "dz", "path mm", "time ns");
  const auto add = [&](std::uint64_t number, const source::Photon& photon, const std::string& event) {
    print_row(number, photon, event);
    steps.push_back(step_json(photon, event));
  };
  add(0, start,
      fmt::format("emitted in {}, {:.2f} nm", point->scene().region_names[start.region],
                  start.wavelength_nm));
  std::uint64_t number = 0;
  point->replay(options.event, options.photon,
                [&](const source::Photon& photon, const transport::Step& step) {
                  add(++number, photon, simulation::step_text(point->scene(), step));
                });
  answer.print([&] { return Json{{"steps", steps}}; });
}

}  // namespace

void add_replay_command(CLI::App& app) {
  auto options = std::make_shared<ReplayOptions>();
  CLI::App* command = app.add_subcommand("replay", "Trace one photon of a run again, step by step");
  command->add_option("SCENE", options->scene, "scene file (TOML), or a results file of its run (HDF5)")
      ->required();
  command->add_option("--event", options->event, "event number, as in the photon list")->required();
  command->add_option("--photon", options->photon, "photon number within the event")->required();
  command->add_option("--point", options->point, "point of the sweep, from 0 (default: 0)");
  command->add_option("--seed", options->seed, "seed, in place of that of the scene or the run");
  add_json_flag(*command, options->json);
  command->footer("Example: scintray replay quickstart.h5 --event 0 --photon 17");
  command->callback([options] { replay_photon(*options); });
}

}  // namespace scintray::cli
