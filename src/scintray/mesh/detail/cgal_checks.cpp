#include "scintray/mesh/detail/cgal_checks.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <array>
#include <limits>

#include "scintray/core/error.hpp"
#include "scintray/mesh/detail/cgal_surface.hpp"

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

/// A plane on one side of which a triangle lies, with the error of its rounding.
struct Bound {
  core::Vec3 outwards;
  /// Square of the error of a distance along `outwards` for each square of the distance from the plane's
  /// origin.
  double error = 0.0;

  /// True when a point is strictly beyond, whatever the rounding.
  bool beyond(const core::Vec3& from_origin) const {
    const double along = outwards.dot(from_origin);
    return along > 0.0 && along * along > error * from_origin.squaredNorm();
  }
};

/// Planes of a triangle: those through its sides (corner k to k + 1) and perpendicular to it, and its own.
struct TrianglePlanes {
  std::array<Bound, 3> side;
  Bound own;

  TrianglePlanes(const std::vector<core::Vec3>& v, const Corners& corner) {
    // Differences, two cross products and a dot product, each right to some units in the last place.
    constexpr double kError = 64 * std::numeric_limits<double>::epsilon();
    std::array<core::Vec3, 3> edge;
    for (std::size_t k = 0; k < 3; ++k) edge[k] = v[corner[(k + 1) % 3]] - v[corner[k]];
    const double size = kError * kError * edge[0].squaredNorm() * edge[1].squaredNorm();
    own = {edge[0].cross(edge[1]), size};
    for (std::size_t k = 0; k < 3; ++k) side[k] = {edge[k].cross(own.outwards), size * edge[k].squaredNorm()};
  }
};

/// Triangles with the planes of each.
class Triangles {
 public:
  explicit Triangles(const TriMesh& mesh) : mesh_(mesh) {
    planes_.reserve(mesh.triangles.size());
    for (const Corners& corner : mesh.triangles) planes_.emplace_back(mesh.vertices, corner);
  }

  /// True when two triangles that share no corner, or one, have nothing else in common, by a plane with one
  /// of them on its one side and the other strictly beyond. It takes a hundredth of the time of the exact
  /// test, and decides nearly every pair of a fan or of other slivers, whose boxes all overlap.
  bool clearly_apart(std::uint32_t a, std::uint32_t b) const {
    const Corners &of_a = mesh_.triangles[a], &of_b = mesh_.triangles[b];
    std::uint32_t common = kNone;
    for (const std::uint32_t i : of_a)
      for (const std::uint32_t j : of_b) {
        if (i != j) continue;
        if (common != kNone && common != i) return false;  // a side in common
        common = i;
      }
    return beyond_a_plane(a, of_b, common) || beyond_a_plane(b, of_a, common);
  }

 private:
  static constexpr auto kNone = std::numeric_limits<std::uint32_t>::max();

  /// @param common  a corner of both, which the plane then contains; kNone: there is none
  bool beyond_a_plane(std::uint32_t triangle, const Corners& other, std::uint32_t common) const {
    const Corners& own = mesh_.triangles[triangle];
    const TrianglePlanes& planes = planes_[triangle];
    const auto all_beyond = [&](const Bound& bound, std::uint32_t origin) {
      for (const std::uint32_t corner : other)
        if (corner != common && !bound.beyond(mesh_.vertices[corner] - mesh_.vertices[origin])) return false;
      return true;
    };
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = own[k], to = own[(k + 1) % 3];
      if ((common == kNone || common == from || common == to) && all_beyond(planes.side[k], from))
        return true;
    }
    const std::uint32_t origin = common == kNone ? own[0] : common;
    return all_beyond(planes.own, origin) || all_beyond({-planes.own.outwards, planes.own.error}, origin);
  }

  const TriMesh& mesh_;
  std::vector<TrianglePlanes> planes_;
};

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

}  // namespace

std::vector<std::pair<std::uint32_t, std::uint32_t>> self_intersections(const TriMesh& mesh) {
  const auto points = points_of(mesh);
  const Triangles triangles(mesh);
  std::vector<Box> boxes;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    if (CGAL::collinear(points[a], points[b], points[c])) continue;
    boxes.emplace_back(points[a].bbox() + points[b].bbox() + points[c].bbox(), static_cast<std::uint32_t>(t));
  }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& a, const Box& b) {
    if (triangles.clearly_apart(a.info(), b.info())) return;
    if (intersect(points, mesh.triangles[a.info()], mesh.triangles[b.info()])) {
      pairs.emplace_back(std::minmax(a.info(), b.info()));
    }
  });
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
