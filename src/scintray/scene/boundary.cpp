#include "scintray/scene/boundary.hpp"

#include <algorithm>
#include <string>
#include <tuple>

#include "scintray/core/error.hpp"
#include "scintray/scene/detail/flat_faces.hpp"

namespace scintray::scene {

namespace {

constexpr std::size_t kMostPlanes = 32;
constexpr std::size_t kMostTrianglesOnMixedPlane = 16;

bool ordered(const core::PlainVec3& a, const core::PlainVec3& b) {
  return std::tuple(a.x(), a.y(), a.z()) < std::tuple(b.x(), b.y(), b.z());
}

/// Sets vertices and corners.
void index_vertices(const std::vector<BoundaryTriangle>& triangles, Boundary& boundary) {
  std::vector<core::PlainVec3>& vertices = boundary.vertices;
  vertices.reserve(3 * triangles.size());
  for (const BoundaryTriangle& triangle : triangles)
    vertices.insert(vertices.end(), triangle.begin(), triangle.end());
  std::sort(vertices.begin(), vertices.end(), ordered);
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  vertices.shrink_to_fit();
  boundary.corners.reserve(3 * triangles.size());
  for (const BoundaryTriangle& triangle : triangles)
    for (const core::Vec3& vertex : triangle)
      boundary.corners.push_back(static_cast<std::uint32_t>(
          std::lower_bound(vertices.begin(), vertices.end(), vertex, ordered) - vertices.begin()));
}

/// The boundary without the planes of a convex region.
Boundary boundary_of(const std::vector<BoundaryTriangle>& triangles, bool closed) {
  Boundary boundary;
  index_vertices(triangles, boundary);
  Eigen::AlignedBox3d bounds;
  boundary.triangle_planes.reserve(triangles.size());
  for (const BoundaryTriangle& t : triangles) {
    const core::Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
    boundary.triangle_planes.push_back({normal, normal.dot(t[0])});
    for (const core::Vec3& vertex : t) bounds.extend(vertex);
  }
  boundary.size_mm = triangles.empty() ? 0.0 : bounds.diagonal().norm();
  boundary.closed = closed;
  return boundary;
}

/// Brings planes of exactly opposite normals together, before all others. @return their number
std::uint32_t pair_opposite(std::vector<BoundingPlane>& planes) {
  auto paired = planes.begin();
  for (auto plane = planes.begin(); plane != planes.end(); ++plane) {
    const auto opposite = std::find_if(plane + 1, planes.end(), [&](const BoundingPlane& other) {
      return other.normal == core::PlainVec3(-plane->normal);
    });
    if (opposite == planes.end()) continue;
    std::rotate(paired, plane, plane + 1);
    std::rotate(paired + 1, opposite, opposite + 1);
    paired += 2;
    plane = paired - 1;
  }
  return static_cast<std::uint32_t>(paired - planes.begin());
}

/// Brings the planes of a box along the axes into the order of Boundary::is_box; false for any others. A part
/// that was turned and is turned back here is a box but for rounding, which its planes then leave out.
/// @param on  triangles on each plane
bool order_as_box(const Boundary& boundary, const std::vector<std::vector<std::uint32_t>>& on,
                  std::vector<BoundingPlane>& planes) {
  if (planes.size() != 6) return false;
  const double tolerance = kCoplanar * boundary.size_mm;
  std::vector<BoundingPlane> ordered;
  for (const core::PlainVec3 axis :
       {core::PlainVec3(1, 0, 0), core::PlainVec3(0, 1, 0), core::PlainVec3(0, 0, 1)})
    for (const double sign : {1.0, -1.0}) {
      const core::PlainVec3 normal(sign * axis.x(), sign * axis.y(), sign * axis.z());
      const auto offset_of = [&](const BoundingPlane& plane) {
        return normal.dot(boundary.triangle(plane.first)[0]);
      };
      const auto is_across = [&](std::uint32_t triangle, double offset) {
        const BoundaryTriangle corners = boundary.triangle(triangle);
        return std::all_of(corners.begin(), corners.end(), [&](const core::Vec3& v) {
          return std::abs(normal.dot(v) - offset) <= tolerance;
        });
      };
      const auto found = std::find_if(planes.begin(), planes.end(), [&](const BoundingPlane& plane) {
        const std::vector<std::uint32_t>& those = on[static_cast<std::size_t>(&plane - planes.data())];
        return plane.normal.dot(normal) > 0.5 &&
               std::all_of(those.begin(), those.end(),
                           [&](std::uint32_t triangle) { return is_across(triangle, offset_of(plane)); });
      });
      if (found == planes.end()) return false;
      ordered.push_back(*found);
      ordered.back().offset = offset_of(*found);
      // Without negative zeros.
      ordered.back().normal = core::PlainVec3(normal.x() + 0.0, normal.y() + 0.0, normal.z() + 0.0);
    }
  planes = std::move(ordered);
  return true;
}

/// Sets the planes of a convex region with few of them; false for any other region.
bool find_planes(const std::vector<std::uint32_t>& labels, Boundary& boundary) {
  if (!boundary.closed || boundary.size() == 0) return false;
  const double tolerance = kCoplanar * boundary.size_mm;
  std::vector<BoundingPlane> planes;
  std::vector<std::vector<std::uint32_t>> on;  // triangles on each
  for (std::uint32_t i = 0; i < boundary.size(); ++i) {
    const BoundaryTriangle corners = boundary.triangle(i);
    const auto on_plane = [&](const BoundingPlane& plane) {
      return plane.normal.dot(boundary.triangle_planes[i].normal) > 0.0 &&
             std::all_of(corners.begin(), corners.end(), [&](const core::Vec3& v) {
               return std::abs(plane.normal.dot(v) - plane.offset) <= tolerance;
             });
    };
    const auto known = std::find_if(planes.begin(), planes.end(), on_plane);
    const auto at = static_cast<std::size_t>(known - planes.begin());
    if (known == planes.end()) {
      if (planes.size() == kMostPlanes) return false;
      planes.push_back({boundary.triangle_planes[i].normal, boundary.triangle_planes[i].offset, i, 0, 0});
      on.emplace_back();
    }
    on[at].push_back(i);
  }
  std::vector<std::uint32_t> plane_triangles;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    BoundingPlane& plane = planes[i];
    for (const core::PlainVec3& vertex : boundary.vertices)
      if (plane.normal.dot(vertex) > plane.offset + tolerance) return false;
    const bool one_label = std::all_of(on[i].begin(), on[i].end(),
                                       [&](std::uint32_t t) { return labels[t] == labels[plane.first]; });
    if (one_label) continue;
    if (on[i].size() > kMostTrianglesOnMixedPlane) return false;
    plane.triangles_begin = static_cast<std::uint32_t>(plane_triangles.size());
    plane_triangles.insert(plane_triangles.end(), on[i].begin(), on[i].end());
    plane.triangles_end = static_cast<std::uint32_t>(plane_triangles.size());
  }
  boundary.is_box = order_as_box(boundary, on, planes);
  boundary.opposite_planes = boundary.is_box ? 6 : pair_opposite(planes);
  boundary.planes = std::move(planes);
  boundary.plane_triangles = std::move(plane_triangles);
  return true;
}

}  // namespace

Boundary make_boundary(const std::vector<BoundaryTriangle>& triangles,
                       const std::vector<std::uint32_t>& labels, bool closed,
                       scene_file::AcceleratorKind kind, ExactBodies exact) {
  Boundary boundary = boundary_of(triangles, closed);
  if (!exact.empty()) {
    boundary.closed = closed && !exact.held;
    boundary.exact = std::move(exact);
    return boundary;
  }
  const bool planes = kind != scene_file::AcceleratorKind::embree && find_planes(labels, boundary);
  if (!planes && kind == scene_file::AcceleratorKind::planes && closed)
    throw core::InputError(
        core::Problem{{},
                      "accelerator \"planes\" is asked for, but a region is not convex with at most " +
                          std::to_string(kMostPlanes) + " planes",
                      "use accelerator = \"auto\" or \"embree\""});
  if (planes) return boundary;
  const std::vector<FlatFace> faces = flat_faces(boundary, labels);
  boundary.merged = merge_flat_faces(boundary, faces);
  if (kind != scene_file::AcceleratorKind::embree) boundary.thin_gaps = find_thin_gaps(boundary, faces);
  return boundary;
}

}  // namespace scintray::scene
