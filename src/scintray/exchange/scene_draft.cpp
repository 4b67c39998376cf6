#include "scintray/exchange/scene_draft.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <span>

#include "scintray/core/error.hpp"
#include "scintray/core/output_file.hpp"
#include "scintray/core/units.hpp"
#include "scintray/mesh/export/triangle_files.hpp"
#include "scintray/mesh/group_summary.hpp"
#include "scintray/mesh/import/file_checks.hpp"
#include "scintray/mesh/import/import.hpp"
#include "scintray/mesh/import/raw_mesh.hpp"

namespace scintray::exchange {

std::filesystem::path scene_file_of(const std::filesystem::path& output) {
  return output.extension() == ".toml" ? output : output / "scene.toml";
}

void write_scene_draft(const SceneDraft& draft, const std::filesystem::path& scene_file) {
  std::error_code error;
  if (std::filesystem::exists(scene_file, error))
    throw core::InputError(core::Problem{{scene_file.string()},
                                         "the scene file exists already and would be lost",
                                         "choose another -o, or remove the file"});
  const auto make_folder = [&error](const std::filesystem::path& folder) {
    if (!folder.empty()) std::filesystem::create_directories(folder, error);
    if (error) throw core::SystemError("cannot make the folder " + folder.string() + ": " + error.message());
  };
  make_folder(scene_file.parent_path());
  for (const auto& [path, mesh] : draft.meshes) {
    const std::filesystem::path file = scene_file.parent_path() / path;
    make_folder(file.parent_path());
    mesh::write_ply(file, mesh);
  }
  core::write_whole_file(scene_file, draft.toml);
}

std::string toml_string(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : mesh::plain_name(text)) {
    if (c == '"' || c == '\\') quoted += '\\';
    if (static_cast<unsigned char>(c) < 0x20)
      quoted += fmt::format("\\u{:04X}", static_cast<unsigned>(c));
    else
      quoted += c;
  }
  return quoted + "\"";
}

std::string part_name(const std::string& name) {
  std::string plain = mesh::plain_name(name);
  std::replace_if(
      plain.begin(), plain.end(),
      [](char c) { return std::string_view(".:*\"'\\ ").find(c) != std::string_view::npos; }, '_');
  return plain.empty() ? "part" : plain;
}

SceneDraft draft_of_model(const std::filesystem::path& file, const ModelImport& options) {
  mesh::ImportOptions import;
  import.tessellation = options.tessellation;
  if (!options.unit.empty()) import.mm_per_unit = core::unit_factor(options.unit, core::Dimension::length);
  const mesh::MeshImport model = mesh::import_mesh(file, import);

  SceneDraft draft;
  draft.toml = "# Made by scintray import from " + file.filename().string() + ".\n" +
               "# Such a file does not contain the media and finishes of its bodies, nor where light\n"
               "# starts: fill in every line that ends in \"required\".\n" +
               "title = " + toml_string(file.stem().string()) + "\n# ambient = \"air\"  # required\n";
  std::vector<std::string> bodies = model.bodies;
  if (bodies.empty()) bodies = {""};
  for (const std::string& body : bodies) {
    draft.toml += "\n[[part]]\nname = " + toml_string(part_name(body.empty() ? file.stem().string() : body)) +
                  "\nmesh = " + toml_string(options.path_in_scene.generic_string()) + "\n";
    if (bodies.size() > 1) draft.toml += "body = " + toml_string(body) + "\n";
    if (!options.unit.empty()) draft.toml += "unit = " + toml_string(options.unit) + "\n";
    if (mesh::is_step(mesh::lower_extension(file)))
      draft.toml +=
          fmt::format("tessellation = {{ deviation = \"{:g} mm\", angle = \"{:g} deg\" }}\n",
                      options.tessellation.deviation_mm, options.tessellation.angle_rad / core::kDegree);
    draft.toml += "# medium = \"LSO\"  # required\n# surface = \"polished\"  # required\n";
  }
  const std::vector<mesh::GroupSummary> groups = mesh::summarize_groups(model.mesh);
  if (groups.size() > 1) {
    constexpr std::size_t kMost = 100;
    draft.toml +=
        "# The file's names for faces, for select = { group = \"...\" } of [[part.face]], the largest "
        "first:\n";
    for (const mesh::GroupSummary& group : std::span(groups).first(std::min(groups.size(), kMost)))
      draft.toml += "#   " + toml_string(group.name) + "  " + mesh::text_of(group) + "\n";
    if (groups.size() > kMost) draft.toml += fmt::format("#   and {} more\n", groups.size() - kMost);
  }
  Eigen::AlignedBox3d box;
  for (const core::Vec3& vertex : model.mesh.vertices) box.extend(vertex);
  const core::Vec3 size = box.isEmpty() ? core::Vec3(core::Vec3::Zero()) : core::Vec3(box.sizes());
  draft.size = fmt::format("{:.5g} x {:.5g} x {:.5g} mm", size.x(), size.y(), size.z());
  draft.toml += "# Size of all bodies together: " + draft.size + "\n";
  draft.toml += "\n# [source]  # required\n# type = \"photons\"\n# region = { part = " +
                toml_string(part_name(bodies.front().empty() ? file.stem().string() : bodies.front())) +
                " }\n# wavelength = \"420 nm\"\n# photons = 100_000\n";
  for (const std::string& note : model.notes)
    if (note.find("all imported together") == std::string::npos) draft.notes.push_back(note);
  draft.missing = {"ambient", "the medium and surface of every part", "[source]"};
  return draft;
}

}  // namespace scintray::exchange
