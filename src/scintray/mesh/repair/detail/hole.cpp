#include "scintray/mesh/repair/detail/passes.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/utility.h>

namespace scintray::mesh {

std::vector<std::array<std::uint32_t, 3>> triangulate_hole(const std::vector<core::Vec3>& loop) {
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
  std::vector<Point> points;
  // CGAL's triangles run along the polyline; the hole's own sense is the reverse of its border's.
  for (auto p = loop.rbegin(); p != loop.rend(); ++p) points.emplace_back(p->x(), p->y(), p->z());
  std::vector<CGAL::Triple<int, int, int>> found;
  CGAL::Polygon_mesh_processing::triangulate_hole_polyline(points, std::back_inserter(found));
  std::vector<std::array<std::uint32_t, 3>> triangles;
  const auto last = static_cast<std::uint32_t>(loop.size() - 1);
  for (const auto& t : found)
    triangles.push_back({last - static_cast<std::uint32_t>(t.first),
                         last - static_cast<std::uint32_t>(t.second),
                         last - static_cast<std::uint32_t>(t.third)});
  return triangles;
}

}  // namespace scintray::mesh
