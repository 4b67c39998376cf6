#include "scintray/mesh/detail/cgal_checks.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <array>

#include "scintray/core/error.hpp"
#include "scintray/mesh/detail/cgal_surface.hpp"
#include "scintray/mesh/detail/triangle_planes.hpp"

namespace scintray::mesh {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Triangle = Kernel::Triangle_3;
using Segment = Kernel::Segment_3;
using Corners = std::array<std::uint32_t, 3>;
using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t>;

std::vector<Point> points_of(const TriMesh& mesh) {
  std::vector<Point> points;
  points.reserve(mesh.vertices.size());
  for (const core::Vec3& v : mesh.vertices) points.emplace_back(v.x(), v.y(), v.z());
  return points;
}

/// Corners of a triangle, those shared with `other` first; returns the number of shared ones.
std::size_t shared_first(Corners& corners, const Corners& other) {
  const auto middle = std::stable_partition(corners.begin(), corners.end(), [&other](std::uint32_t v) {
    return std::find(other.begin(), other.end(), v) != other.end();
  });
  return static_cast<std::size_t>(middle - corners.begin());
}

bool intersect(const std::vector<Point>& p, Corners a, Corners b) {
  const std::size_t shared = shared_first(a, b);
  shared_first(b, a);
  const Triangle first(p[a[0]], p[a[1]], p[a[2]]), second(p[b[0]], p[b[1]], p[b[2]]);
  if (shared == 0) return CGAL::do_intersect(first, second);
  if (shared == 1) {  // beyond the common vertex exactly when an opposite side intersects the other triangle
    return CGAL::do_intersect(Segment(p[a[1]], p[a[2]]), second) ||
           CGAL::do_intersect(Segment(p[b[1]], p[b[2]]), first);
  }
  if (shared == 2) {  // folded onto each other
    return CGAL::coplanar(p[a[0]], p[a[1]], p[a[2]], p[b[2]]) &&
           CGAL::coplanar_orientation(p[a[0]], p[a[1]], p[a[2]], p[b[2]]) == CGAL::POSITIVE;
  }
  return false;
}

/// The exact test of pairs of triangles whose boxes overlap.
class CrossingTest {
 public:
  /// The mesh must outlive this object.
  explicit CrossingTest(const TriMesh& mesh) : mesh_(mesh), points_(points_of(mesh)), planes_(mesh) {}

  /// Adds the box of a triangle, unless it has no area.
  void add_box(std::uint32_t t, std::vector<Box>& boxes) const {
    const auto& [a, b, c] = mesh_.triangles[t];
    if (CGAL::collinear(points_[a], points_[b], points_[c])) return;
    boxes.emplace_back(points_[a].bbox() + points_[b].bbox() + points_[c].bbox(), t);
  }

  bool cross(std::uint32_t a, std::uint32_t b) const {
    return !planes_.clearly_apart(a, b) && intersect(points_, mesh_.triangles[a], mesh_.triangles[b]);
  }

 private:
  const TriMesh& mesh_;
  std::vector<Point> points_;
  TrianglePlanes planes_;
};

}  // namespace

std::vector<std::pair<std::uint32_t, std::uint32_t>> self_intersections(const TriMesh& mesh) {
  const CrossingTest test(mesh);
  std::vector<Box> boxes;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) test.add_box(t, boxes);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& a, const Box& b) {
    if (test.cross(a.info(), b.info())) pairs.emplace_back(std::minmax(a.info(), b.info()));
  });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> crossings_with(const TriMesh& mesh,
                                                                    const std::vector<std::uint32_t>& listed,
                                                                    const std::vector<char>& alive) {
  const CrossingTest test(mesh);
  std::vector<Box> of_listed, others;
  std::vector<char> is_listed(mesh.triangles.size(), 0);
  for (const std::uint32_t t : listed) is_listed[t] = 1;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    if (alive[t] != 0) test.add_box(t, is_listed[t] != 0 ? of_listed : others);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  const auto compare = [&](const Box& a, const Box& b) {
    if (test.cross(a.info(), b.info())) pairs.emplace_back(std::minmax(a.info(), b.info()));
  };
  CGAL::box_self_intersection_d(of_listed.begin(), of_listed.end(), compare);
  CGAL::box_intersection_d(of_listed.begin(), of_listed.end(), others.begin(), others.end(), compare);
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

std::vector<char> reversed_to_bound_a_volume(const TriMesh& mesh) {
  Soup<Point> soup(mesh);
  pmp::orient_polygon_soup(soup.points, soup.polygons);  // splits vertices in which several bodies touch
  if (!pmp::is_polygon_soup_a_polygon_mesh(soup.polygons)) {
    throw core::InternalError("a closed, consistently oriented mesh is not a polygon mesh for CGAL");
  }
  CGAL::Surface_mesh<Point> surface;
  pmp::polygon_soup_to_polygon_mesh(soup.points, soup.polygons, surface);
  pmp::orient_to_bound_a_volume(surface);

  std::vector<char> reversed(mesh.triangles.size());
  for (const auto face : surface.faces()) {
    const auto t = static_cast<std::size_t>(face);
    const core::Vec3& first = mesh.vertices[mesh.triangles[t][0]];
    const core::Vec3& second = mesh.vertices[mesh.triangles[t][1]];
    const auto at = [&surface](auto halfedge, const core::Vec3& v) {
      return surface.point(surface.target(halfedge)) == Point(v.x(), v.y(), v.z());
    };
    auto halfedge = surface.halfedge(face);
    for (int turn = 0; turn < 3 && !at(halfedge, first); ++turn) halfedge = surface.next(halfedge);
    reversed[t] = !at(surface.next(halfedge), second);
  }
  return reversed;
}

}  // namespace scintray::mesh
