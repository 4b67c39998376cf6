#include "scintray/mesh/import/raw_mesh.hpp"

#include <algorithm>
#include <array>

#include "scintray/mesh/shapes/polygon.hpp"

namespace scintray::mesh {

std::string group_name(const std::string& object, const std::string& material) {
  if (object.empty()) return material.empty() ? "default" : material;
  return material.empty() ? object : object + ":" + material;
}

void RawMesh::begin_body(const std::string& name) {
  fill_body();
  const std::string base = name.empty() ? "body" : name;
  std::string unique = base;
  for (int number = 2; std::find(bodies.begin(), bodies.end(), unique) != bodies.end(); ++number)
    unique = base + " " + std::to_string(number);
  bodies.push_back(unique);
}

void RawMesh::fill_body() {
  if (!bodies.empty()) body_of.resize(mesh.triangles.size(), static_cast<std::uint32_t>(bodies.size() - 1));
}

bool RawMesh::add_polygon(const std::vector<std::uint32_t>& corners, std::uint32_t group_of_polygon,
                          bool mirrored) {
  if (corners.size() < 3) {
    ++points_and_lines;
    return true;
  }
  if (corners.size() > kMostCorners) return false;
  std::vector<core::Vec3> points;
  points.reserve(corners.size());
  for (const std::uint32_t corner : corners) points.push_back(mesh.vertices[corner]);
  bool simple = true;
  for (const auto& [i, j, k] : triangulate_polygon(points, simple)) {
    const std::uint32_t a = corners[i], b = corners[j], c = corners[k];
    mesh.triangles.push_back(mirrored ? std::array{a, c, b} : std::array{a, b, c});
    mesh.group.push_back(group_of_polygon);
  }
  if (!simple) ++crossing_polygons;
  return true;
}

}  // namespace scintray::mesh
