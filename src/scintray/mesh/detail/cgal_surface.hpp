#pragma once
/// Conversion between TriMesh and CGAL's meshes, as templates: the files that include CGAL supply the types.

#include <array>
#include <cstdint>
#include <vector>

#include "scintray/mesh/trimesh.hpp"
#include "scintray/mesh/weld.hpp"

namespace scintray::mesh {

/// A mesh in the form of CGAL's polygon soups. `Point` is constructed from three numbers.
template <typename Point>
struct Soup {
  std::vector<Point> points;
  std::vector<std::vector<std::size_t>> polygons;

  /// Without the vertices that no triangle uses: CGAL reads the neighbours of every vertex, and crashes on
  /// one that has none. Triangles keep their order.
  explicit Soup(TriMesh mesh) {
    drop_unused_vertices(mesh);
    points.reserve(mesh.vertices.size());
    for (const core::Vec3& v : mesh.vertices) points.emplace_back(v.x(), v.y(), v.z());
    polygons.reserve(mesh.triangles.size());
    for (const auto& [a, b, c] : mesh.triangles) polygons.push_back({a, b, c});
  }
};

/// A CGAL::Surface_mesh of triangles as a mesh, each triangle's group being its face's entry in `groups`.
template <typename Surface, typename Groups>
TriMesh mesh_of(const Surface& surface, const Groups& groups) {
  TriMesh mesh;
  std::vector<std::uint32_t> index(surface.number_of_vertices() + surface.number_of_removed_vertices());
  for (const auto vertex : surface.vertices()) {
    index[vertex] = static_cast<std::uint32_t>(mesh.vertices.size());
    const auto& p = surface.point(vertex);
    mesh.vertices.emplace_back(p.x(), p.y(), p.z());
  }
  for (const auto face : surface.faces()) {
    std::array<std::uint32_t, 3> triangle{};
    std::size_t k = 0;
    for (const auto vertex : surface.vertices_around_face(surface.halfedge(face)))
      triangle[k++] = index[vertex];
    mesh.triangles.push_back(triangle);
    mesh.group.push_back(groups[face]);
  }
  return mesh;
}

}  // namespace scintray::mesh
