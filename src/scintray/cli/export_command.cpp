#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "scintray/cli/progress.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/output_file.hpp"
#include "scintray/exchange/scene_draft.hpp"
#include "scintray/mesh/import/file_checks.hpp"
#include "scintray/results/results.hpp"
#include "scintray/simulation/simulation.hpp"

namespace scintray::cli {

namespace {

struct ExportArguments {
  std::filesystem::path scene, output;
  std::string table = "photons";
  std::uint64_t point = 0;
};

void export_table(const ExportArguments& arguments) {
  const std::uint64_t rows = with_progress("writing " + arguments.output.string(), [&] {
    return results::export_rows(arguments.scene, arguments.table, arguments.output);
  });
  std::cout << "wrote " << rows << " rows of " << arguments.table << " to " << arguments.output.string()
            << "\n";
}

void export_scene(const ExportArguments& arguments) {
  if (mesh::lower_extension(arguments.output) != ".gdml")
    throw core::InputError(core::Problem{{arguments.output.string()},
                                         "scenes are exported as GDML",
                                         "name a file that ends in .gdml, as: -o detector.gdml"});
  simulation::Simulation simulation(scene_file::SceneFile::load(arguments.scene));
  const auto point = with_progress("building the scene", [&] { return simulation.point(arguments.point); });
  const exchange::gdml::GdmlExport gdml = exchange::gdml::export_gdml(*point->built());
  core::write_whole_file(arguments.output, gdml.text);
  for (const std::string& note : gdml.notes) std::cout << "not the same in Geant4: " << note << "\n";
  std::cout << "wrote " << arguments.output.string() << "\n";
}

}  // namespace

void add_export_command(CLI::App& app) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command =
      app.add_subcommand("export", "Write a scene as GDML, or rows of a result as CSV, NumPy or LH5");
  command->add_option("FILE", arguments->scene, "scene file (TOML), or results file (HDF5)")->required();
  command
      ->add_option("-o,--output", arguments->output,
                   "file to write: .gdml of a scene; .csv, .npy, .lh5 of a result")
      ->required();
  command->add_option("--point", arguments->point, "point of the sweep, from 0 (default: 0)");
  command->add_option("--table", arguments->table,
                      "rows of a result: photons, events, signals, paths, path_steps (default: photons)");
  command->footer(
      "Examples:\n"
      "  scintray export quickstart.toml -o quickstart.gdml\n"
      "  scintray export quickstart.h5 --table events -o events.npy");
  command->callback([arguments] {
    const std::string extension = mesh::lower_extension(arguments->scene);
    if (extension == ".h5" || extension == ".hdf5" || extension == ".hdf")
      export_table(*arguments);
    else
      export_scene(*arguments);
  });
}

}  // namespace scintray::cli
