#include "scintray/mesh/weld.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <vector>

#include "scintray/mesh/detail/edges.hpp"
#include "scintray/mesh/diagnosis.hpp"

namespace scintray::mesh {
namespace {

constexpr auto kNone = std::numeric_limits<std::uint32_t>::max();

/// Representatives by cell of a grid of spacing 4 * length, so that a point's neighbours within
/// `length` lie in at most 8 cells and mostly in one.
class VertexGrid {
 public:
  explicit VertexGrid(double length) : length_(length), cell_(4.0 * length) {}

  /// The earliest representative within `length` of point along every axis, or kNone.
  std::uint32_t find(const core::Vec3& point, const std::vector<core::Vec3>& vertices) const {
    const auto low = cell_of(point - core::Vec3::Constant(length_)),
               high = cell_of(point + core::Vec3::Constant(length_));
    std::uint32_t found = kNone;
    for (std::int64_t x = low[0]; x <= high[0]; ++x) {
      for (std::int64_t y = low[1]; y <= high[1]; ++y) {
        for (std::int64_t z = low[2]; z <= high[2]; ++z) {
          const auto cell = first_in_cell_.find({x, y, z});
          if (cell == first_in_cell_.end()) continue;
          for (const std::uint32_t v : cell->second) {
            if ((vertices[v] - point).cwiseAbs().maxCoeff() <= length_) found = std::min(found, v);
          }
        }
      }
    }
    return found;
  }

  void insert(std::uint32_t vertex, const core::Vec3& point) {
    first_in_cell_[cell_of(point)].push_back(vertex);
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  struct Hash {
    std::size_t operator()(const Cell& cell) const {
      std::uint64_t h = 0;
      for (const std::int64_t i : cell) {
        h = (h ^ static_cast<std::uint64_t>(i)) * 0x9E3779B97F4A7C15ULL;
        h ^= h >> 29;
      }
      return static_cast<std::size_t>(h);
    }
  };

  /// Coordinates are at most 2^22 lengths, so cells are below 2^20 and fit.
  Cell cell_of(const core::Vec3& point) const {
    if (cell_ == 0.0) return {0, 0, 0};  // every coordinate is zero
    Cell cell;
    for (int axis = 0; axis < 3; ++axis) {
      cell[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(std::floor(point[axis] / cell_));
    }
    return cell;
  }

  double length_, cell_;
  std::unordered_map<Cell, std::vector<std::uint32_t>, Hash> first_in_cell_;
};

/// The corner between the other two along the triangle's longest edge.
std::size_t middle_corner(const TriMesh& mesh, std::size_t triangle) {
  const auto& corner = mesh.triangles[triangle];
  std::size_t middle = 0;
  double longest = -1.0;
  for (std::size_t side = 0; side < 3; ++side) {
    const double length =
        (mesh.vertices[corner[(side + 1) % 3]] - mesh.vertices[corner[(side + 2) % 3]]).norm();
    if (length > longest) {
      longest = length;
      middle = side;
    }
  }
  return middle;
}

bool has_equal_corners(const std::array<std::uint32_t, 3>& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

/// One pass of remove_degenerate: removes degenerate triangles no two of which share a neighbour.
class DegeneratePass {
 public:
  DegeneratePass(TriMesh& mesh, double length_mm) : mesh_(mesh), length_mm_(length_mm) {}

  /// Returns false when nothing is degenerate. With `cut_neighbours` false slits remain.
  bool run(bool cut_neighbours, DegenerateRemoval& total) {
    std::vector<std::size_t> flat;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (is_degenerate(mesh_, t, length_mm_)) flat.push_back(t);
    }
    if (flat.empty()) return false;
    gone_.assign(mesh_.triangles.size(), false);
    cut_at_.assign(mesh_.triangles.size(), kNone);
    cut_edge_.assign(mesh_.triangles.size(), 0);
    longest_.assign(mesh_.triangles.size(), 0.0);
    for (const std::size_t t : flat) {
      const auto& corner = mesh_.triangles[t];
      for (std::size_t side = 0; side < 3; ++side)
        longest_[t] = std::max(
            longest_[t], (mesh_.vertices[corner[side]] - mesh_.vertices[corner[(side + 1) % 3]]).norm());
    }
    for (const std::size_t t : flat) {
      if (has_equal_corners(mesh_.triangles[t]) || !cut_neighbours) gone_[t] = true;
    }
    const auto uses = sorted_edge_uses(mesh_);
    for (const std::size_t t : flat) take_out(t, uses);
    rebuild(total);
    return true;
  }

 private:
  void take_out(std::size_t t, const std::vector<EdgeUse>& uses) {
    if (gone_[t] || cut_at_[t] != kNone) return;
    const std::size_t middle = middle_corner(mesh_, t);
    const std::uint32_t a = mesh_.triangles[t][(middle + 1) % 3], b = mesh_.triangles[t][(middle + 2) % 3];
    const std::uint32_t low = std::min(a, b), high = std::max(a, b);
    auto use = std::lower_bound(uses.begin(), uses.end(), std::pair(low, high),
                                [](const EdgeUse& u, const auto& e) { return std::pair(u.low, u.high) < e; });
    // The neighbour across the edge runs along it the other way. Where welding has brought four triangles
    // together at an edge, another one would belong to another sheet, and cutting it would open both.
    const auto last =
        std::find_if(use, uses.end(), [&](const EdgeUse& u) { return u.low != low || u.high != high; });
    const auto opposite = [&](const EdgeUse& u) {
      return u.triangle != t && u.forward != (a < b) && !has_equal_corners(mesh_.triangles[u.triangle]);
    };
    if (const auto found = std::find_if(use, last, opposite); found != last) use = found;
    for (; use != last; ++use) {
      const std::size_t other = use->triangle;
      if (other == t || has_equal_corners(mesh_.triangles[other])) continue;
      if (gone_[other] || cut_at_[other] != kNone) return;  // removed in the next pass
      // Of slivers along one line the longest is removed first: cut at a shorter one's corner it would only
      // become two that are cut back.
      if (longest_[other] > longest_[t]) return;
      cut_at_[other] = mesh_.triangles[t][middle];
      const auto& corner = mesh_.triangles[other];
      for (std::size_t side = 0; side < 3; ++side) {
        const std::uint32_t from = corner[side], to = corner[(side + 1) % 3];
        if (std::min(from, to) == low && std::max(from, to) == high) cut_edge_[other] = side;
      }
      break;
    }
    gone_[t] = true;
  }

  void rebuild(DegenerateRemoval& total) {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::uint32_t> group, support;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (gone_[t]) {
        ++total.removed;
        continue;
      }
      const auto& corner = mesh_.triangles[t];
      const std::uint32_t own_group = mesh_.group.empty() ? 0 : mesh_.group[t];
      if (cut_at_[t] == kNone) {
        triangles.push_back(corner);
        group.push_back(own_group);
        support.push_back(mesh_.support_of(t));
        continue;
      }
      const std::size_t side = cut_edge_[t];
      const std::uint32_t from = corner[side], to = corner[(side + 1) % 3], tip = corner[(side + 2) % 3];
      triangles.push_back({from, cut_at_[t], tip});
      triangles.push_back({cut_at_[t], to, tip});
      group.insert(group.end(), 2, own_group);
      support.insert(support.end(), 2, mesh_.support_of(t));
      ++total.cut;
    }
    mesh_.triangles = std::move(triangles);
    if (!mesh_.group.empty()) mesh_.group = std::move(group);
    if (!mesh_.support.empty()) mesh_.support = std::move(support);
  }

  TriMesh& mesh_;
  double length_mm_;
  std::vector<bool> gone_;
  std::vector<std::uint32_t> cut_at_;  ///< vertex to cut the triangle at
  std::vector<double> longest_;        ///< longest edge of a degenerate triangle, 0 for others
  std::vector<std::size_t> cut_edge_;  ///< first corner of the edge that is cut
};

}  // namespace

void drop_unused_vertices(TriMesh& mesh) {
  std::vector<std::uint32_t> index(mesh.vertices.size(), kNone);
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) index[v] = 0;
  }
  std::uint32_t next = 0;
  for (std::size_t v = 0; v < index.size(); ++v) {
    if (index[v] == kNone) continue;
    mesh.vertices[next] = mesh.vertices[v];
    index[v] = next++;
  }
  mesh.vertices.resize(next);
  for (auto& triangle : mesh.triangles) {
    for (std::uint32_t& v : triangle) v = index[v];
  }
}

std::size_t weld_vertices(TriMesh& mesh, double length_mm) {
  const std::size_t before = mesh.vertices.size();
  drop_unused_vertices(mesh);  // they may be anywhere, beyond the cells of the grid too
  std::vector<std::uint32_t> index(mesh.vertices.size());
  std::vector<core::Vec3> kept;
  VertexGrid grid(length_mm);
  for (std::size_t v = 0; v < index.size(); ++v) {
    const core::Vec3& point = mesh.vertices[v];
    std::uint32_t representative = grid.find(point, kept);
    if (representative == kNone) {
      representative = static_cast<std::uint32_t>(kept.size());
      kept.push_back(point);
      grid.insert(representative, point);
    }
    index[v] = representative;
  }
  mesh.vertices = std::move(kept);
  for (auto& triangle : mesh.triangles) {
    for (std::uint32_t& v : triangle) v = index[v];
  }
  return before - mesh.vertices.size();
}

DegenerateRemoval remove_degenerate(TriMesh& mesh, double length_mm) {
  // A cut makes edges shorter, so chains of slivers end; the bound is for meshes that consist of
  // slivers, where slits no longer matter.
  constexpr int kMostPasses = 100;
  DegenerateRemoval total;
  int pass = 0;
  while (DegeneratePass(mesh, length_mm).run(pass < kMostPasses, total)) ++pass;
  drop_unused_vertices(mesh);
  return total;
}

}  // namespace scintray::mesh
