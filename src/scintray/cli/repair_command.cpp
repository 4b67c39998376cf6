#include <CLI/CLI.hpp>
#include <memory>

#include "scintray/cli/exit_codes.hpp"
#include "scintray/cli/json_answer.hpp"
#include "scintray/cli/repair.hpp"
#include "scintray/core/units.hpp"
#include "scintray/mesh/import/file_checks.hpp"
#include "scintray/mesh/repair/repair.hpp"

namespace scintray::cli {

namespace {

Json diagnosis_json(const mesh::MeshDiagnosis& d) {
  return {{"triangles", d.triangles},
          {"bodies", d.bodies},
          {"area_mm2", json_of(d.area_mm2)},
          {"volume_mm3", json_of(d.volume_mm3)},
          {"open_edges", d.open_edges.count},
          {"non_manifold_edges", d.nonmanifold_edges.count},
          {"flipped_edges", d.flipped_edges.count},
          {"triangles_without_area", d.degenerate_triangles.count},
          {"duplicate_triangles", d.duplicate_triangles.count},
          {"crossing_pairs", d.self_intersections.count},
          {"bodies_inside_out", d.inverted_bodies.count}};
}

}  // namespace

void add_repair_command(CLI::App& app) {
  struct Options {
    std::filesystem::path in, out;
    std::string unit, body, weld, largest_hole;
    bool json = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("repair", "Repair a mesh, or all meshes of a scene, and print the changes");
  command->add_option("FILE", options->in, "mesh file, or scene file (.toml)")->required();
  command
      ->add_option(
          "-o,--output", options->out,
          "mesh file to write: .stl, .ply (double precision) or .glb (keeps groups and tags); for a scene, "
          "a folder")
      ->required();
  command->add_option("--unit", options->unit, "unit of the numbers in a mesh file, as mm (glTF: metres)");
  command->add_option("--body", options->body, "the one body of a mesh file to repair, by name or number");
  command->add_option("--weld", options->weld,
                      "merge vertices this near to each other (default: single-precision rounding)");
  command->add_option("--largest-hole", options->largest_hole,
                      "leave larger holes open (default: a quarter of the mesh's diagonal)");
  add_json_flag(*command, options->json);
  command->footer(
      "Examples:\n"
      "  scintray repair crystal.stl --unit mm -o crystal_mended.stl\n"
      "  scintray repair scene.toml -o mended");
  command->callback([options] {
    const auto length = [](const std::string& text) {
      return text.empty() ? 0.0 : core::parse_quantity(text, core::Dimension::length);
    };
    const mesh::RepairSettings settings{length(options->weld), length(options->largest_hole)};
    mesh::ImportOptions import;
    import.mm_per_unit =
        options->unit.empty() ? 0.0 : core::unit_factor(options->unit, core::Dimension::length);
    import.body = options->body;
    const JsonAnswer answer(options->json);
    Json meshes = Json::array();
    const RepairReport report = [&](const std::filesystem::path& file, const mesh::MeshDiagnosis& found,
                                    const mesh::MeshDiagnosis& written) {
      meshes.push_back(
          {{"file", file.string()}, {"found", diagnosis_json(found)}, {"written", diagnosis_json(written)}});
    };
    const bool sound = mesh::lower_extension(options->in) == ".toml"
                           ? repair_scene(options->in, options->out, settings, report)
                           : repair_file(options->in, import, options->out, settings, report);
    answer.print([&] { return Json{{"sound", sound}, {"meshes", meshes}}; });
    if (!sound) throw CLI::RuntimeError(kBadInput);
  });
}

}  // namespace scintray::cli
