#include "scintray/mesh/shapes/solids.hpp"
#include "scintray/mesh/degenerate.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/mesh/diagnosis.hpp"
#include "scintray/mesh/shapes/polygon.hpp"
#include "scintray/mesh/shapes/primitives.hpp"
#include "scintray/mesh/shapes/shape_error.hpp"
#include "scintray/mesh/weld.hpp"

namespace scintray::mesh {
namespace {

void add_end(TriMesh& mesh, const std::vector<std::uint32_t>& ring) {
  if (ring.size() > kMostCorners) reject_shape("an outline of more corners than can be cut in triangles", "");
  std::vector<core::Vec3> corners;
  for (const std::uint32_t v : ring) corners.push_back(mesh.vertices[v]);
  bool simple = true;
  for (const auto& [a, b, c] : triangulate_polygon(corners, simple))
    mesh.triangles.push_back({ring[a], ring[b], ring[c]});
  if (!simple) reject_shape("an outline crosses itself", "give its corners in order along its edge");
}

/// Walls between two rings, corner by corner.
void add_walls(TriMesh& mesh, const std::vector<std::uint32_t>& ring,
               const std::vector<std::uint32_t>& next) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const std::size_t j = (i + 1) % ring.size();
    mesh.triangles.push_back({ring[i], ring[j], next[j]});
    mesh.triangles.push_back({ring[i], next[j], next[i]});
  }
}

/// Merges coincident corners, removes walls without area, and orients the triangles outwards: they agree by
/// construction, so that the sign of the volume decides.
TriMesh finished(TriMesh mesh) {
  mesh.groups = {"default"};
  mesh.group.assign(mesh.triangles.size(), 0);
  const double length_mm = rounding_length(mesh);
  weld_vertices(mesh, length_mm);
  remove_degenerate(mesh, length_mm);
  mesh.group.assign(mesh.triangles.size(), 0);
  if (mesh.volume() < 0.0) reverse_orientation(mesh);
  return mesh;
}

std::vector<std::uint32_t> add_ring(TriMesh& mesh, const std::vector<core::Vec3>& corners) {
  std::vector<std::uint32_t> ring;
  for (const core::Vec3& corner : corners) {
    ring.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
    mesh.vertices.push_back(corner);
  }
  return ring;
}

void check_size(std::size_t corners, std::size_t rings) {
  if (corners > kMostSweptTriangles / 2 / std::max<std::size_t>(rings, 1))
    reject_shape("the body would be cut in more than " + std::to_string(kMostSweptTriangles) + " triangles",
                 "allow a larger deviation");
}

}  // namespace

TriMesh revolved(const std::vector<Eigen::Vector2d>& outline, const Turn& turn) {
  if (outline.size() < 3) reject_shape("an outline of fewer than 3 corners", "");
  for (const Eigen::Vector2d& corner : outline)
    if (!corner.allFinite() || corner.x() < 0.0) reject_shape("an outline with a radius below 0", "");
  constexpr double kRounding = 1e-9;
  const bool full = turn.extent_rad >= core::kTwoPi - kRounding;
  if (turn.segments < (full ? 3 : 1)) reject_shape("a turn in fewer segments than make a body", "");
  if (!(turn.extent_rad > 0.0)) reject_shape("a turn through no angle", "give an angle above 0");
  const auto steps = static_cast<std::size_t>(turn.segments);
  check_size(outline.size(), steps);

  TriMesh mesh;
  std::vector<std::vector<std::uint32_t>> rings;
  for (std::size_t step = 0; step < (full ? steps : steps + 1); ++step) {
    const double phi = turn.start_rad + (full ? core::kTwoPi : turn.extent_rad) * static_cast<double>(step) /
                                            static_cast<double>(steps);
    std::vector<core::Vec3> corners;
    for (const Eigen::Vector2d& corner : outline)
      corners.emplace_back(corner.x() * std::cos(phi), corner.x() * std::sin(phi), corner.y());
    rings.push_back(add_ring(mesh, corners));
  }
  for (std::size_t i = 0; i + 1 < rings.size(); ++i) add_walls(mesh, rings[i], rings[i + 1]);
  if (full) {
    add_walls(mesh, rings.back(), rings.front());
  } else {
    add_end(mesh, {rings.front().rbegin(), rings.front().rend()});
    add_end(mesh, rings.back());
  }
  return finished(std::move(mesh));
}

TriMesh lofted(const std::vector<std::vector<core::Vec3>>& outlines) {
  if (outlines.size() < 2 || outlines.front().size() < 3)
    reject_shape("a body between fewer than 2 outlines, or outlines of fewer than 3 corners", "");
  check_size(outlines.front().size(), outlines.size());
  TriMesh mesh;
  std::vector<std::vector<std::uint32_t>> rings;
  for (const std::vector<core::Vec3>& outline : outlines) {
    if (outline.size() != outlines.front().size())
      reject_shape("a body between outlines of different numbers of corners", "");
    rings.push_back(add_ring(mesh, outline));
  }
  for (std::size_t i = 0; i + 1 < rings.size(); ++i) add_walls(mesh, rings[i], rings[i + 1]);
  add_end(mesh, {rings.front().rbegin(), rings.front().rend()});
  add_end(mesh, rings.back());
  return finished(std::move(mesh));
}

TriMesh mapped_cube(const std::array<int, 3>& steps, const std::array<bool, 3>& closed,
                    const std::function<core::Vec3(const core::Vec3&)>& map) {
  double triangles = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (steps[axis] < (closed[axis] ? 3 : 1)) reject_shape("a body in fewer steps than make one", "");
    if (!closed[axis]) triangles += 4.0 * steps[(axis + 1) % 3] * steps[(axis + 2) % 3];
  }
  if (triangles > static_cast<double>(kMostSweptTriangles)) check_size(kMostSweptTriangles, 2);
  TriMesh mesh;
  const auto add_face = [&](std::size_t axis, double end) {
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::vector<std::uint32_t> below;
    for (int j = 0; j <= steps[v]; ++j) {
      std::vector<core::Vec3> row;
      for (int i = 0; i <= steps[u]; ++i) {
        core::Vec3 at;
        at[static_cast<Eigen::Index>(axis)] = end;
        // The ends of a closed axis are one point, in every bit.
        at[static_cast<Eigen::Index>(u)] =
            closed[u] && i == steps[u] ? 0.0 : static_cast<double>(i) / steps[u];
        at[static_cast<Eigen::Index>(v)] =
            closed[v] && j == steps[v] ? 0.0 : static_cast<double>(j) / steps[v];
        row.push_back(map(at));
      }
      std::vector<std::uint32_t> ring = add_ring(mesh, row);
      for (std::size_t i = 0; j > 0 && i + 1 < ring.size(); ++i) {
        mesh.triangles.push_back({below[i], below[i + 1], ring[i + 1]});
        mesh.triangles.push_back({below[i], ring[i + 1], ring[i]});
        if (end == 0.0)
          for (std::size_t k = mesh.triangles.size() - 2; k < mesh.triangles.size(); ++k)
            std::swap(mesh.triangles[k][1], mesh.triangles[k][2]);
      }
      below = std::move(ring);
    }
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const double end : {0.0, 1.0})
      if (!closed[axis]) add_face(axis, end);
  return finished(std::move(mesh));
}

std::vector<Eigen::Vector2d> arc(const Eigen::Vector2d& centre, double a, double b, double from_rad,
                                 double to_rad, const Tessellation& tessellation) {
  const int segments = arc_segments(std::max(a, b), std::abs(to_rad - from_rad), tessellation, 2);
  std::vector<Eigen::Vector2d> corners;
  for (int i = 0; i <= segments; ++i) {
    const double angle = from_rad + (to_rad - from_rad) * i / segments;
    // The ends of a quarter lie on the axis exactly.
    const double r = a * std::cos(angle);
    corners.emplace_back(centre.x() + (std::abs(r) < 1e-12 * a ? 0.0 : r), centre.y() + b * std::sin(angle));
  }
  return corners;
}

}  // namespace scintray::mesh
