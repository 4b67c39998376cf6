#include "scintray/mesh/import.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "scintray/core/error.hpp"
#include "scintray/mesh/assimp_import.hpp"
#include "scintray/mesh/diagnosis.hpp"
#include "scintray/mesh/file_checks.hpp"
#include "scintray/mesh/gltf_import.hpp"
#include "scintray/mesh/ply_import.hpp"
#include "scintray/mesh/weld.hpp"

namespace scintray {
namespace {

std::string list_of_extensions() {
  std::string list;
  for (const std::string& extension : mesh_extensions()) list += (list.empty() ? "" : ", ") + extension;
  return list;
}

RawMesh read_raw(const std::filesystem::path& path, const std::string& extension) {
  const std::string content = read_mesh_file(path);
  check_claimed_sizes(path, extension, content);
  if (extension == ".gltf") return import_gltf(path, content, false);
  if (extension == ".glb") return import_gltf(path, content, true);
  if (extension == ".ply") return import_ply(path, content);
  return import_through_assimp(path);
}

double resolve_unit(const std::filesystem::path& path, double mm_per_unit,
                    const std::string& unit_from_file) {
  if (!std::isfinite(mm_per_unit) || mm_per_unit < 0.0) {
    reject_file(path, "the mesh's unit is not a positive length", "give for example unit = \"mm\"");
  }
  if (mm_per_unit > 0.0) return mm_per_unit;
  if (unit_from_file == "m") return 1000.0;
  reject_file(path, "the file does not say in which unit its coordinates are",
              "say it beside the mesh, for example unit = \"mm\" (or \"um\", \"cm\", \"m\", \"inch\")");
}

void check_vertices(const std::filesystem::path& path, const TriMesh& mesh) {
  // Beyond this, areas and volumes in single-precision ray tracing overflow.
  constexpr double kLargest_mm = 1e12;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Vec3& p = mesh.vertices[mesh.triangles[t][corner]];
      if (p.allFinite() && p.cwiseAbs().maxCoeff() <= kLargest_mm) continue;
      std::ostringstream text;
      text << "vertex " << corner + 1 << " of triangle " << t + 1 << " is at (" << p.x() << ", " << p.y()
           << ", " << p.z() << ") mm, which is not a finite place within 1e12 mm";
      reject_file(path, text.str(), "repair the mesh in the program that made it, or check its unit");
    }
  }
}

}  // namespace

const std::vector<std::string>& mesh_extensions() {
  static const std::vector<std::string> extensions = {".stl", ".obj", ".ply",  ".off",
                                                      ".3mf", ".dae", ".gltf", ".glb"};
  return extensions;
}

MeshImport import_mesh(const std::filesystem::path& path, double mm_per_unit) {
  const std::string extension = lower_extension(path);
  const auto& known = mesh_extensions();
  if (std::find(known.begin(), known.end(), extension) == known.end()) {
    reject_file(path,
                "\"" + extension + "\" is not a mesh format that can be read; expected one of " +
                    list_of_extensions(),
                "export the mesh in one of these formats");
  }
  RawMesh raw = read_raw(path, extension);
  const double scale = resolve_unit(path, mm_per_unit, raw.unit_from_file);
  MeshImport result{std::move(raw.mesh), raw.unit_from_file, std::move(raw.notes), 0};
  TriMesh& mesh = result.mesh;
  if (raw.points_and_lines > 0) {
    result.notes.push_back(std::to_string(raw.points_and_lines) +
                           " points and lines left out: they bound no solid");
  }
  if (raw.crossing_polygons > 0) {
    result.notes.push_back(std::to_string(raw.crossing_polygons) +
                           " polygons cross themselves and were cut in triangles as well as may be");
  }
  if (mesh.triangles.empty()) {
    reject_file(path, "the file holds no triangles",
                "a part needs a closed surface of triangles or polygons");
  }
  if (mm_per_unit > 0.0 && raw.unit_from_file == "m" && mm_per_unit != 1000.0) {
    result.notes.push_back("the unit given replaces the metre that glTF prescribes");
  }
  for (Vec3& vertex : mesh.vertices) vertex *= scale;
  check_vertices(path, mesh);

  const double length = rounding_length(mesh);
  weld_vertices(mesh, length);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (is_degenerate(mesh, t, length)) ++result.degenerate_triangles;
  }
  const DegenerateRemoval removal = remove_degenerate(mesh, length);
  if (result.degenerate_triangles > 0) {
    result.notes.push_back(std::to_string(result.degenerate_triangles) +
                           " triangles without area kept out, " + std::to_string(removal.cut) +
                           " neighbours cut to close the slits they leave");
  }
  if (mesh.triangles.empty()) {
    reject_file(path, "no triangle in the file has an area", "check the mesh in the program that made it");
  }
  return result;
}

}  // namespace scintray
