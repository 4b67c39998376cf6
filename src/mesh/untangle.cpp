#include "scintray/mesh/untangle.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <array>
#include <vector>

#include "scintray/mesh/weld.hpp"

namespace scintray {

std::optional<TriMesh> untangled(const TriMesh& mesh) {
  namespace pmp = CGAL::Polygon_mesh_processing;
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
  using Surface = CGAL::Surface_mesh<Point>;

  TriMesh used = mesh;
  drop_unused_vertices(used);  // CGAL crashes on a vertex without neighbours
  std::vector<Point> points;
  for (const Vec3& v : used.vertices) points.emplace_back(v.x(), v.y(), v.z());
  std::vector<std::vector<std::size_t>> polygons;
  for (const auto& [a, b, c] : used.triangles) polygons.push_back({a, b, c});
  pmp::orient_polygon_soup(points, polygons);  // splits vertices in which several bodies touch
  if (!pmp::is_polygon_soup_a_polygon_mesh(polygons)) return std::nullopt;
  Surface surface;
  pmp::polygon_soup_to_polygon_mesh(points, polygons, surface);
  auto group = surface.add_property_map<Surface::Face_index, std::uint32_t>("f:group", 0U).first;
  for (const auto face : surface.faces()) group[face] = mesh.group.empty() ? 0 : mesh.group[face];

  if (!pmp::experimental::remove_self_intersections(surface, CGAL::parameters::preserve_genus(false)))
    return std::nullopt;

  TriMesh result;
  result.groups = mesh.groups;
  std::vector<std::uint32_t> index(surface.number_of_vertices() + surface.number_of_removed_vertices());
  for (const auto vertex : surface.vertices()) {
    index[vertex] = static_cast<std::uint32_t>(result.vertices.size());
    const Point& p = surface.point(vertex);
    result.vertices.emplace_back(p.x(), p.y(), p.z());
  }
  for (const auto face : surface.faces()) {
    std::array<std::uint32_t, 3> triangle{};
    std::size_t k = 0;
    for (const auto vertex : surface.vertices_around_face(surface.halfedge(face)))
      triangle[k++] = index[vertex];
    result.triangles.push_back(triangle);
    result.group.push_back(group[face]);
  }
  return result;
}

}  // namespace scintray
