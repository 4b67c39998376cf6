#include "scintray/mesh/shapes/detail/loft.hpp"

#include <algorithm>

namespace scintray::mesh {

namespace {

/// Adds vertices and triangles, each vertex of a ring once.
class Lofter {
 public:
  std::vector<std::uint32_t> add_ring(const LoftRing& ring) {
    std::vector<std::uint32_t> ids;
    for (std::size_t i = 0; i < ring.corners.size(); ++i) {
      const bool same_as_last = i > 0 && ring.corners[i] == ring.corners[i - 1];
      const bool same_as_first = i + 1 == ring.corners.size() && i > 0 && ring.corners[i] == ring.corners[0];
      if (same_as_last) {
        ids.push_back(ids.back());
      } else if (same_as_first) {
        ids.push_back(ids.front());
      } else {
        ids.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
        mesh.vertices.emplace_back(ring.corners[i].x(), ring.corners[i].y(), ring.z);
      }
    }
    return ids;
  }

  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, const std::string& group) {
    if (a == b || b == c || c == a) return;
    mesh.triangles.push_back({a, b, c});
    mesh.group.push_back(group_id(group));
  }

  void add_cap(const std::vector<std::uint32_t>& ring, bool top, const std::string& group) {
    for (std::size_t i = 1; i + 1 < ring.size(); ++i)
      add_triangle(ring[0], top ? ring[i] : ring[i + 1], top ? ring[i + 1] : ring[i], group);
  }

  TriMesh mesh;

 private:
  std::uint32_t group_id(const std::string& name) {
    const auto found = std::find(mesh.groups.begin(), mesh.groups.end(), name);
    if (found == mesh.groups.end()) {
      mesh.groups.push_back(name);
      return static_cast<std::uint32_t>(mesh.groups.size() - 1);
    }
    return static_cast<std::uint32_t>(found - mesh.groups.begin());
  }
};

}  // namespace

TriMesh make_loft(const std::vector<LoftRing>& rings,
                  const std::vector<std::vector<std::string>>& side_groups) {
  Lofter lofter;
  std::vector<std::vector<std::uint32_t>> ids;
  for (const LoftRing& ring : rings) ids.push_back(lofter.add_ring(ring));
  for (std::size_t layer = 0; layer + 1 < ids.size(); ++layer) {
    const auto &low = ids[layer], &high = ids[layer + 1];
    for (std::size_t i = 0; i < low.size(); ++i) {
      const std::size_t next = (i + 1) % low.size();
      const std::string& group = side_groups[layer][i];
      lofter.add_triangle(low[i], low[next], high[next], group);
      lofter.add_triangle(low[i], high[next], high[i], group);
    }
  }
  lofter.add_cap(ids.front(), false, "-z");
  lofter.add_cap(ids.back(), true, "+z");
  return std::move(lofter.mesh);
}

std::vector<Eigen::Vector2d> regular_polygon(int corners, double circumradius) {
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < corners; ++i) {
    const double angle = core::kTwoPi * i / corners;
    points.emplace_back(circumradius * std::cos(angle), circumradius * std::sin(angle));
  }
  return points;
}

std::vector<Eigen::Vector2d> rectangle_corners(const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
  return {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
}

}  // namespace scintray::mesh
