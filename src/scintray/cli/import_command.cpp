#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "scintray/cli/json_answer.hpp"
#include "scintray/cli/progress.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/units.hpp"
#include "scintray/exchange/scene_draft.hpp"
#include "scintray/mesh/import/file_checks.hpp"

namespace scintray::cli {

namespace {

struct SceneImportArguments {
  std::filesystem::path file, output;
  std::string unit, deviation, angle;
  std::vector<std::string> media, surfaces;
  bool skip_unsupported = false;
  bool json = false;
};

/// "A=B" pairs of an option.
std::map<std::string, std::string> pairs(const std::string& option, const std::vector<std::string>& given) {
  std::map<std::string, std::string> result;
  for (const std::string& pair : given) {
    const std::size_t equals = pair.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == pair.size())
      throw core::InputError(core::Problem{
          {}, option + " \"" + pair + "\" is not of the form NAME=NAME", "as " + option + " Water=water"});
    result[pair.substr(0, equals)] = pair.substr(equals + 1);
  }
  return result;
}

mesh::Tessellation tessellation_of(const SceneImportArguments& arguments, mesh::Tessellation tessellation) {
  if (!arguments.deviation.empty()) {
    tessellation.deviation_mm = core::parse_quantity(arguments.deviation, core::Dimension::length);
    tessellation.deviation_per_radius = 0.0;
  }
  if (!arguments.angle.empty())
    tessellation.angle_rad = core::parse_quantity(arguments.angle, core::Dimension::angle);
  if (!(tessellation.deviation_mm > 0.0) || tessellation.angle_rad < 0.1 * core::kDegree * (1.0 - 1e-9) ||
      tessellation.angle_rad > 90.0 * core::kDegree)
    throw core::InputError(
        core::Problem{{},
                      "--deviation is not above 0, or --angle is not between 0.1 and 90 deg",
                      "the defaults are \"0.01 mm\" and \"5 deg\""});
  return tessellation;
}

/// Refuses files that hold neither geometry nor definitions of a kind that is read.
void refuse_other_files(const std::filesystem::path& file) {
  const std::string extension = mesh::lower_extension(file);
  if (extension == ".toml")
    throw core::InputError(core::Problem{
        {file.string()}, "this is a scene already", "inspect it with: scintray check " + file.string()});
  if (extension == ".db")
    throw core::InputError(
        core::Problem{{file.string()},
                      "a material database of GATE holds densities and compositions alone",
                      "import the macro (.mac) that names it, with Materials.xml beside it"});
}

/// A draft of a file of Geant4 or GATE.
exchange::SceneDraft draft_of_detector(const SceneImportArguments& arguments,
                                       const std::filesystem::path& scene) {
  if (!arguments.unit.empty())
    throw core::InputError(core::Problem{
        {}, "--unit with a GDML file or a file of GATE", "remove it: its solids state their units"});
  const exchange::gdml::GdmlImport options{.tessellation = tessellation_of(arguments, exchange::gdml::GdmlImport().tessellation),
                                           .media = pairs("--medium", arguments.media),
                                           .surfaces = pairs("--surface", arguments.surfaces),
                                           .skip_unsupported = arguments.skip_unsupported,
                                           .mesh_folder = scene.stem().string() + "_meshes",
                                           .notes = {}};
  const std::string extension = mesh::lower_extension(arguments.file);
  if (extension == ".mac") return exchange::gate::draft_of_gate(arguments.file, options);
  if (extension == ".xml") return exchange::gate::definitions_of_gate(arguments.file, options);
  return exchange::gdml::draft_of_gdml(mesh::read_mesh_file(arguments.file), arguments.file.string(),
                                       options);
}

exchange::SceneDraft draft_of(const SceneImportArguments& arguments, const std::filesystem::path& scene) {
  refuse_other_files(arguments.file);
  const std::string extension = mesh::lower_extension(arguments.file);
  if (extension == ".gdml" || extension == ".mac" || extension == ".xml")
    return draft_of_detector(arguments, scene);
  if (!arguments.media.empty() || !arguments.surfaces.empty() || arguments.skip_unsupported)
    throw core::InputError(
        core::Problem{{},
                      "--medium, --surface and --skip-unsupported are for GDML files and macros of GATE",
                      "fill in the media and surfaces in the scene that is written"});
  const auto folder = std::filesystem::absolute(scene).parent_path();
  return exchange::draft_of_model(arguments.file,
                                  {arguments.unit, tessellation_of(arguments, {}),
                                   std::filesystem::absolute(arguments.file).lexically_relative(folder)});
}

void import_scene(const SceneImportArguments& arguments) {
  const JsonAnswer answer(arguments.json);
  const std::filesystem::path scene = exchange::scene_file_of(arguments.output);
  const exchange::SceneDraft draft =
      with_progress("reading " + arguments.file.string(), [&] { return draft_of(arguments, scene); });
  with_progress("writing " + scene.string(), [&] { exchange::write_scene_draft(draft, scene); });
  for (const std::string& note : draft.notes) std::cout << "not carried over, or different: " << note << "\n";
  std::cout << "wrote " << scene.string();
  if (!draft.meshes.empty()) std::cout << " and " << draft.meshes.size() << " meshes beside it";
  std::cout << "\n";
  if (!draft.size.empty()) std::cout << "size " << draft.size << ": a wrong --unit shows here\n";
  for (const std::string& missing : draft.missing) std::cout << "to be filled in: " << missing << "\n";
  answer.print([&] {
    return Json{{"scene", scene.string()},
                {"meshes", draft.meshes.size()},
                {"size", draft.size},
                {"notes", draft.notes},
                {"missing", draft.missing}};
  });
  if (draft.missing.empty()) std::cout << "inspect it with: scintray check " << scene.string() << "\n";
}

}  // namespace

void add_import_command(CLI::App& app) {
  auto arguments = std::make_shared<SceneImportArguments>();
  CLI::App* command = app.add_subcommand(
      "import", "Write a scene from a GDML file, a macro of GATE, or the bodies of a CAD or mesh file");
  command
      ->add_option("FILE", arguments->file,
                   "GDML, STEP, glTF, 3MF, COLLADA, OBJ, STL, PLY or OFF file; GATE macro (.mac), "
                   "Materials.xml or Surfaces.xml")
      ->required();
  command
      ->add_option("-o,--output", arguments->output,
                   "Scene file to write (.toml), or a folder for scene.toml")
      ->required();
  command->add_option("--unit", arguments->unit, "Unit of a mesh file that does not state it, as mm or inch");
  command->add_option("--deviation", arguments->deviation,
                      "Largest distance of triangles from curved faces (default: \"0.01 mm\"; for solids of GDML and "
                      "GATE 1e-4 of their radius, where that is more)");
  command->add_option("--angle", arguments->angle,
                      "Largest angle between neighbouring triangles of a curved face (default: \"5 deg\")");
  command->add_option(
      "--medium", arguments->media,
      "GDML, GATE: use this medium of the database for a material, as Air=air; may be repeated");
  command->add_option("--surface", arguments->surfaces,
                      "GDML, GATE: use this surface of the database for an optical surface; may be repeated");
  command->add_flag("--skip-unsupported", arguments->skip_unsupported,
                    "GDML: leave out volumes whose solid is not supported, instead of stopping");
  add_json_flag(*command, arguments->json);
  command->footer(
      "Examples:\n"
      "  scintray import detector.step -o detector.toml\n"
      "  scintray import detector.gdml -o detector.toml --medium Air=air --skip-unsupported");
  command->callback([arguments] { import_scene(*arguments); });
}

}  // namespace scintray::cli
