#include "scintray/mesh/import/import.hpp"
#include "scintray/mesh/degenerate.hpp"

#include <cmath>
#include <cstdio>
#include <sstream>

#include "scintray/core/error.hpp"
#include "scintray/core/text.hpp"
#include "scintray/mesh/diagnosis.hpp"
#include "scintray/mesh/import/detail/import_steps.hpp"
#include "scintray/mesh/import/file_checks.hpp"
#include "scintray/mesh/weld.hpp"

namespace scintray::mesh {
namespace {

std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

void check_vertices(const std::filesystem::path& path, const TriMesh& mesh) {
  // Beyond this, areas and volumes in single-precision ray tracing overflow.
  constexpr double kLargest_mm = 1e12;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const core::Vec3& p = mesh.vertices[mesh.triangles[t][corner]];
      if (p.allFinite() && p.cwiseAbs().maxCoeff() <= kLargest_mm) continue;
      std::ostringstream text;
      text << "vertex " << corner + 1 << " of triangle " << t + 1 << " is at (" << p.x() << ", " << p.y()
           << ", " << p.z() << ") mm, which is not a finite place within 1e12 mm";
      reject_file(path, text.str(), "repair the mesh in the program that made it, or check its unit");
    }
  }
}

}  // namespace

const std::vector<std::string>& mesh_extensions() { return MeshFormats::built_in().extensions(); }

bool is_step(const std::string& extension) {
  const MeshFormat* format = MeshFormats::built_in().find(extension);
  return format && format->is_step;
}

bool states_its_unit(const std::string& extension) {
  const MeshFormat* format = MeshFormats::built_in().find(extension);
  return format && format->states_unit;
}

MeshImport import_mesh(const std::filesystem::path& path, double mm_per_unit) {
  ImportOptions options;
  options.mm_per_unit = mm_per_unit;
  return import_mesh(path, options);
}

MeshImport import_mesh(const std::filesystem::path& path, const ImportOptions& options) {
  return import_raw(path, read_raw(path, options), options);
}

RawMesh read_raw(const std::filesystem::path& path, const ImportOptions& options) {
  const std::string extension = lower_extension(path);
  const MeshFormat* format = options.formats->find(extension);
  if (!format) {
    reject_file(path,
                "\"" + extension + "\" is not a mesh format that can be read; expected one of " +
                    core::list_of(options.formats->extensions()),
                "export the mesh in one of these formats");
  }
  if (!std::isfinite(options.scale) || options.scale <= 0.0)
    reject_file(path, "the mesh's scale is not a positive number", "give a factor above 0");
  Tessellation tessellation = options.tessellation;
  tessellation.deviation_mm /= options.scale;
  const std::string content = read_mesh_file(path);
  check_stated_sizes(path, format->extension, content);
  RawMesh raw = format->read({path, content, tessellation});
  for (std::string& group : raw.mesh.groups) group = plain_name(group);
  for (FaceTags& tags : raw.mesh.group_tags) {
    FaceTags plain;
    for (const auto& [key, value] : tags) plain[plain_name(key)] = plain_name(value);
    tags = std::move(plain);
  }
  for (std::string& note : raw.notes) note = plain_name(note);
  return raw;
}

MeshImport import_raw(const std::filesystem::path& path, RawMesh raw, const ImportOptions& options) {
  std::vector<std::string> unit_notes;
  const double scale = options.scale * resolve_unit(path, options.mm_per_unit, raw.unit, unit_notes);
  raw.notes.insert(raw.notes.begin(), unit_notes.begin(), unit_notes.end());
  choose_body(path, raw, options.body);
  if (raw.deviation_mm > 0.0) {
    raw.notes.push_back("curved CAD faces tessellated within " +
                        number_text(raw.deviation_mm * options.scale) + " mm" +
                        " of them (requested: " + number_text(options.tessellation.deviation_mm) +
                        " mm and " + number_text(options.tessellation.angle_rad / core::kDegree) + " deg)");
  }
  MeshImport result{std::move(raw.mesh), raw.unit.name, std::move(raw.notes), 0, std::move(raw.bodies)};
  TriMesh& mesh = result.mesh;
  if (raw.points_and_lines > 0) {
    result.notes.push_back(std::to_string(raw.points_and_lines) +
                           " points and lines left out: they bound no solid");
  }
  if (raw.crossing_polygons > 0) {
    result.notes.push_back(std::to_string(raw.crossing_polygons) +
                           " polygons cross themselves and were triangulated approximately");
  }
  if (mesh.triangles.empty()) {
    reject_file(path, "the file holds no triangles",
                "a part needs a closed surface of triangles or polygons");
  }
  for (core::Vec3& vertex : mesh.vertices) vertex *= scale;
  for (SupportSurface& surface : mesh.supports)
    surface = surface.moved(Eigen::Affine3d(Eigen::Scaling(scale))).value();
  if (mesh.supports.empty()) mesh.support.clear();
  check_vertices(path, mesh);

  const double length = rounding_length(mesh);
  weld_vertices(mesh, length);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (is_degenerate(mesh, t, length)) ++result.degenerate_triangles;
  }
  const DegenerateRemoval removal = remove_degenerate(mesh, length);
  if (result.degenerate_triangles > 0) {
    result.notes.push_back(
        std::to_string(result.degenerate_triangles) + " triangles without area left out, " +
        std::to_string(removal.cut) + " neighbours cut to close the slits they leave" +
        (removal.merged > 0
             ? ", " + std::to_string(removal.merged) + " vertices on smooth borders merged with the next one"
             : ""));
  }
  if (mesh.triangles.empty()) {
    reject_file(path, "no triangle in the file has an area", "check the mesh in the program that made it");
  }
  return result;
}

}  // namespace scintray::mesh
