#include "scintray/mesh/repair/detail/passes.hpp"

// Its smoothing computes normals of vertices, at a cost of the fourth power of their number of edges.
#define CGAL_PMP_REMOVE_SELF_INTERSECTIONS_NO_SMOOTHING
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include "scintray/mesh/detail/cgal_surface.hpp"

namespace scintray::mesh {

std::optional<TriMesh> untangled(const TriMesh& mesh) {
  namespace pmp = CGAL::Polygon_mesh_processing;
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
  using Surface = CGAL::Surface_mesh<Point>;

  Soup<Point> soup(mesh);
  pmp::orient_polygon_soup(soup.points, soup.polygons);  // splits vertices in which several bodies touch
  if (!pmp::is_polygon_soup_a_polygon_mesh(soup.polygons)) return std::nullopt;
  Surface surface;
  pmp::polygon_soup_to_polygon_mesh(soup.points, soup.polygons, surface);
  auto group = surface.add_property_map<Surface::Face_index, std::uint32_t>("f:group", 0U).first;
  for (const auto face : surface.faces()) group[face] = mesh.group.empty() ? 0 : mesh.group[face];

  if (!pmp::experimental::remove_self_intersections(surface, CGAL::parameters::preserve_genus(false)))
    return std::nullopt;

  TriMesh result = mesh_of(surface, group);
  result.groups = mesh.groups;
  result.group_tags = mesh.group_tags;
  return result;
}

}  // namespace scintray::mesh
