#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "scintray/core/error.hpp"
#include "scintray/core/output_file.hpp"
#include "scintray/exchange/scene_draft.hpp"
#include "scintray/mesh/import/file_checks.hpp"
#include "scintray/simulation/simulation.hpp"

namespace scintray::cli {

namespace {

struct ExportArguments {
  std::filesystem::path scene, output;
  std::uint64_t point = 0;
};

void export_scene(const ExportArguments& arguments) {
  if (mesh::lower_extension(arguments.output) != ".gdml")
    throw core::InputError(core::Problem{{arguments.output.string()},
                                         "scenes are exported as GDML",
                                         "name a file that ends in .gdml, as: -o detector.gdml"});
  simulation::Simulation simulation(scene_file::SceneFile::load(arguments.scene));
  const auto point = simulation.point(arguments.point);
  const exchange::gdml::GdmlExport gdml = exchange::gdml::export_gdml(*point->built());
  core::write_whole_file(arguments.output, gdml.text);
  for (const std::string& note : gdml.notes) std::cout << "not the same in Geant4: " << note << "\n";
  std::cout << "wrote " << arguments.output.string() << "\n";
}

}  // namespace

void add_export_command(CLI::App& app) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command = app.add_subcommand("export", "Write a scene as GDML, for Geant4");
  command->add_option("SCENE", arguments->scene, "scene file (TOML)")->required();
  command->add_option("-o,--output", arguments->output, "GDML file to write")->required();
  command->add_option("--point", arguments->point, "point of the sweep, from 0 (default: 0)");
  command->footer("Example: scintray export quickstart.toml -o quickstart.gdml");
  command->callback([arguments] { export_scene(*arguments); });
}

}  // namespace scintray::cli
