#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <set>
#include <string>

#include "scintray/cli/check.hpp"
#include "scintray/cli/interrupt.hpp"
#include "scintray/cli/json_answer.hpp"
#include "scintray/cli/scene_notes.hpp"
#include "scintray/cli/watched_surfaces.hpp"
#include "scintray/simulation/simulation.hpp"

namespace scintray::cli {

namespace {

struct CheckOptions {
  std::filesystem::path scene, picture;
  bool every_point = false;
  bool all = false;
  bool json = false;
};

void print_source(const source::LightSource& source, const scene::Scene& scene) {
  std::set<std::string> origins;  // a small region is given in pieces
  std::string first;
  for (const core::RegionId id : source.regions()) {
    if (first.empty()) first = scene.region_names[id];
    origins.insert(scene.region_names[id]);
  }
  std::cout << "\nsource: "
            << (source.has_energy() ? fmt::format("{} events, light", source.events())
                                    : fmt::format("{} photons", source.photons()))
            << " from \"" << first << "\"";
  if (origins.size() > 1)
    std::cout << " and " << origins.size() - 1 << " more part" << (origins.size() > 2 ? "s" : "");
  std::cout << "\n";
}

Json problem_json(const core::Problem& problem) {
  return {{"what", problem.what}, {"hint", problem.hint}, {"places_mm", problem.places_mm}};
}

/// The numbers of a point: its parts and faces, and the findings.
Json point_json(const scene::BuiltScene& built, const GapFindings& gaps) {
  Json parts = Json::array(), faces = Json::array(), warnings = Json::array();
  for (const core::PartId id : built.scene.parts.ids()) {
    const scene::PartReport& part = built.parts[id.index()];
    const mesh::MeshDiagnosis& d = part.diagnosis;
    parts.push_back(
        {{"name", part.name},
         {"medium",
          built.scene.media[built.scene.regions[built.scene.parts[id].region].medium].medium().name},
         {"volume_mm3",
          json_of(built.scene.parts[id].curved ? built.scene.parts[id].volume_mm3 : d.volume_mm3)},
         {"triangles", d.triangles},
         {"closed", d.closed()},
         {"notes", part.notes}});
  }
  for (const scene::FaceInfo& face : built.scene.faces)
    faces.push_back({{"name", face.name},
                     {"surface", face.surface},
                     {"area_mm2", json_of(face.area_mm2)},
                     {"contact_area_mm2", json_of(face.contact_area_mm2)},
                     {"exact", face.exact}});
  for (const core::Problem& warning : gaps.warnings) warnings.push_back(problem_json(warning));
  for (const std::string& warning : built.warnings) warnings.push_back({{"what", warning}});
  return {{"low_nm", json_of(built.scene.low_nm)},
          {"high_nm", json_of(built.scene.high_nm)},
          {"parts", parts},
          {"faces", faces},
          {"interfaces", built.scene.interfaces.size()},
          {"warnings", warnings}};
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
  const JsonAnswer answer(options.json);
  Json points = Json::array();
  const std::filesystem::path& path = options.scene;
  if (!options.picture.empty()) expect_picture_name(options.picture);
  const scene_file::SceneFile file = load_or_draw(options);
  ProgressLine line(true);
  const ActivityWatch watch(line);
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
    if (!shown) {
      line.clear();
      continue;
    }
    const scene_file::SceneSpec& spec = ready->spec();
    const scene::BuiltScene& built = *ready->built();
    const GapFindings gaps = find_gaps(*ready, options.all);
    line.clear();
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
    points.push_back(point_json(built, gaps));
    points.back()["parameters"] = file.parameters(point);
  }
  std::cout << "\n"
            << path.string() << ": no errors in " << file.points() << " point"
            << (file.points() == 1 ? "" : "s") << "\n";
  answer.print([&] { return Json{{"scene", path.string()}, {"points", points}}; });
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
  add_json_flag(*command, options->json);
  command->footer(
      "Examples:\n"
      "  scintray check quickstart.toml\n"
      "  scintray check quickstart.toml --picture quickstart.svg");
  command->callback([options] {
    const InterruptGuard guard;
    check_scene(*options);
  });
}

}  // namespace scintray::cli
