#include "scintray/cli/check_command.hpp"

#include <fmt/format.h>

#include <iostream>
#include <memory>

#include "scintray/cli/interrupt.hpp"
#include "scintray/cli/progress.hpp"
#include "scintray/io/simulate.hpp"
#include "scintray/source/photon_source.hpp"
#include "scintray/tally/block_tally.hpp"

namespace scintray::cli {

namespace {

std::string yes_no(bool value) { return value ? "yes" : "NO"; }

void print_parts(const BuiltScene& built) {
  const Scene& scene = built.scene;
  std::cout << "\nparts\n";
  std::cout << fmt::format("  {:<20} {:<22} {:>12} {:>11} {:>9} {:>7} {:>8} {:>10}\n", "name", "medium",
                           "volume mm3", "area mm2", "triangles", "closed", "outwards", "degenerate");
  for (std::size_t i = 0; i < built.parts.size(); ++i) {
    const MeshDiagnosis& d = built.parts[i].diagnosis;
    const Region& region = scene.regions[scene.parts[i].region];
    std::cout << fmt::format("  {:<20} {:<22} {:>12.6g} {:>11.6g} {:>9} {:>7} {:>8} {:>10}\n",
                             built.parts[i].name, scene.media[region.medium].medium().name, d.volume_mm3,
                             d.area_mm2, d.triangles, yes_no(d.closed()), yes_no(d.outward()),
                             d.degenerate_triangles.count);
    for (const std::string& note : built.parts[i].notes) std::cout << "    note: " << note << "\n";
  }
}

void print_faces(const Scene& scene) {
  std::cout << "\nfaces\n";
  std::cout << fmt::format("  {:<28} {:<28} {:>11} {:>14} {:>9}\n", "part:face", "surface", "area mm2",
                           "in contact mm2", "triangles");
  for (const FaceInfo& face : scene.faces)
    std::cout << fmt::format("  {:<28} {:<28} {:>11.6g} {:>14.6g} {:>9}\n", face.name, face.surface,
                             face.area_mm2, face.contact_area_mm2, face.triangles);
}

void print_regions(const Scene& scene) {
  std::cout << fmt::format("\nregions ({}, sharing {} accelerators)\n", scene.regions.size(),
                           scene.accelerators);
  std::cout << fmt::format("  {:<20} {:<22} {:>9} {:>10} {}\n", "name", "medium", "triangles", "index",
                           "ray queries by");
  for (const Region& region : scene.regions) {
    const SceneMedium& medium = scene.media[region.medium];
    const Accelerator& accelerator = *region.accelerator;
    const std::string index =
        medium.is_opaque() ? "-" : fmt::format("{:.4f}", medium.index(0.5 * (scene.low_nm + scene.high_nm)));
    const std::string how = accelerator.uses_planes() ? fmt::format("{} planes", accelerator.plane_count())
                            : accelerator.size() == 0 ? "nothing to meet"
                                                      : "Embree";
    std::cout << fmt::format("  {:<20} {:<22} {:>9} {:>10} {}\n", region.name, medium.medium().name,
                             accelerator.size(), index, how);
  }
}

std::string interface_optics(const Scene& scene, const Interface& interface) {
  const auto name = [&](std::int32_t id) { return scene.surfaces[static_cast<std::size_t>(id)].name; };
  std::string text;
  if (interface.back_surface != kNone) text = name(interface.back_surface);
  if (interface.gap_medium != kNone)
    text +=
        " | dry gap of " + scene.media[static_cast<std::size_t>(interface.gap_medium)].medium().name + " | ";
  if (interface.front_surface != kNone) text += name(interface.front_surface);
  const auto sensor = [&](std::int32_t id) {
    if (id != kNone) text += ", detected by " + scene.sensors[static_cast<std::size_t>(id)].name;
  };
  sensor(interface.front_sensor);
  sensor(interface.back_sensor);
  return text;
}

void print_interfaces(const Scene& scene) {
  std::cout << fmt::format("\ninterfaces ({})\n", scene.interfaces.size());
  for (std::size_t i = 0; i < scene.interfaces.size(); ++i) {
    const Interface& interface = scene.interfaces[i];
    std::cout << fmt::format("  {:<20} | {:<20} {:>11.6g} mm2  {}\n", scene.regions[interface.back].name,
                             scene.regions[interface.front].name, scene.interface_area_mm2[i],
                             interface_optics(scene, interface));
  }
}

void check_scene(const std::filesystem::path& path, bool every_point) {
  const SceneFile file = SceneFile::load(path);
  ProgressLine line(true);
  SurfaceMaker::Hooks hooks;
  hooks.table_progress = [&line](const std::string& surface, double done) {
    line.show("building the table of " + surface, done, 1.0, "");
  };
  hooks.stop = [] { return InterruptGuard::requested().load(); };
  SceneBuilder builder(hooks);
  for (std::size_t point = 0; point < file.points(); ++point) {
    const SceneSpec spec = file.spec(point);
    const BuiltScene built = builder.build(spec);
    const PhotonSource source(spec.source, built.scene);
    const TallyPlan plan(built.scene, spec);
    line.clear();
    if (point > 0 && !every_point) continue;
    if (file.points() > 1) {
      std::cout << (point > 0 ? "\n" : "") << "point " << point + 1 << " of " << file.points() << ":";
      for (std::size_t k = 0; k < file.sweep_keys().size(); ++k)
        std::cout << "  " << file.sweep_keys()[k] << " = " << file.parameters(point)[k];
      std::cout << "\n";
    }
    std::cout << fmt::format(
        "wavelengths in use: {:g} to {:g} nm; ambient medium: {}; contacts are {} by default{}\n",
        built.scene.low_nm, built.scene.high_nm, spec.ambient.name,
        spec.contacts_default == ContactKind::bonded ? "bonded" : "dry",
        spec.contacts_default_given ? "" : " (not stated in the scene)");
    print_parts(built);
    print_faces(built.scene);
    print_regions(built.scene);
    print_interfaces(built.scene);
    const std::vector<std::uint32_t> origins = source.regions();
    std::cout << "\nsource: " << source.photons() << " photons from \""
              << built.scene.regions[origins.front()].name << "\"";
    if (origins.size() > 1) std::cout << " and " << origins.size() - 1 << " more parts";
    std::cout << "\n";
    for (const std::string& warning : built.warnings) std::cout << "warning: " << warning << "\n";
  }
  std::cout << "\n"
            << path.string() << ": no errors in " << file.points() << " point"
            << (file.points() == 1 ? "" : "s") << "\n";
}

}  // namespace

void add_check_command(CLI::App& app) {
  struct Options {
    std::filesystem::path scene;
    bool every_point = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("check", "Say what a scene is, or everything that is wrong with it");
  command->add_option("SCENE", options->scene, "scene file (TOML)")->required();
  command->add_flag("--every-point", options->every_point,
                    "print every point of a sweep, not only the first");
  command->callback([options] {
    const InterruptGuard guard;
    check_scene(options->scene, options->every_point);
  });
}

}  // namespace scintray::cli
