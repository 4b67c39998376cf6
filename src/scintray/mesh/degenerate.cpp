#include "scintray/mesh/degenerate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

#include "scintray/mesh/detail/edges.hpp"
#include "scintray/mesh/diagnosis.hpp"
#include "scintray/mesh/weld.hpp"

namespace scintray::mesh {
namespace {

constexpr auto kNotCut = std::numeric_limits<std::uint32_t>::max();

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

double longest_edge(const TriMesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  const core::Vec3 &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
  return std::max({(q - p).norm(), (r - q).norm(), (p - r).norm()});
}

std::vector<std::size_t> degenerate_triangles(const TriMesh& mesh, double length_mm) {
  std::vector<std::size_t> flat;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (is_degenerate(mesh, t, length_mm)) flat.push_back(t);
  return flat;
}

/// One pass of remove_degenerate: removes degenerate triangles no two of which share a neighbour.
class DegeneratePass {
 public:
  explicit DegeneratePass(TriMesh& mesh) : mesh_(mesh) {}

  /// With `cut_neighbours` false slits remain.
  void run(const std::vector<std::size_t>& flat, bool cut_neighbours, DegenerateRemoval& total) {
    gone_.assign(mesh_.triangles.size(), false);
    cut_at_.assign(mesh_.triangles.size(), kNotCut);
    cut_edge_.assign(mesh_.triangles.size(), 0);
    longest_.assign(mesh_.triangles.size(), 0.0);
    for (const std::size_t t : flat) longest_[t] = longest_edge(mesh_, t);
    for (const std::size_t t : flat) {
      if (has_equal_corners(mesh_.triangles[t]) || !cut_neighbours) gone_[t] = true;
    }
    const std::vector<EdgeUse> uses = uses_of_long_edges(flat);
    for (const std::size_t t : flat) take_out(t, uses);
    rebuild(total);
  }

 private:
  /// Sorted uses of the longest edges of these triangles, and of some others. Degenerate triangles are few:
  /// to sort the edges of all others in each pass took most of the time of importing large assemblies.
  std::vector<EdgeUse> uses_of_long_edges(const std::vector<std::size_t>& flat) const {
    std::vector<char> at_end(mesh_.vertices.size(), 0);
    for (const std::size_t t : flat) {
      const std::size_t middle = middle_corner(mesh_, t);
      for (const std::size_t end : {middle + 1, middle + 2}) at_end[mesh_.triangles[t][end % 3]] = 1;
    }
    TriMesh beside;
    std::vector<std::uint32_t> number;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const auto& corner = mesh_.triangles[t];
      if (at_end[corner[0]] + at_end[corner[1]] + at_end[corner[2]] < 2) continue;
      beside.triangles.push_back(corner);
      number.push_back(static_cast<std::uint32_t>(t));
    }
    std::vector<EdgeUse> uses = sorted_edge_uses(beside);
    for (EdgeUse& use : uses) use.triangle = number[use.triangle];
    return uses;
  }

  void take_out(std::size_t t, const std::vector<EdgeUse>& uses) {
    if (gone_[t] || cut_at_[t] != kNotCut) return;
    const std::size_t middle = middle_corner(mesh_, t);
    const std::uint32_t a = mesh_.triangles[t][(middle + 1) % 3], b = mesh_.triangles[t][(middle + 2) % 3];
    const std::uint32_t low = std::min(a, b), high = std::max(a, b);
    auto use = std::lower_bound(uses.begin(), uses.end(), std::pair(low, high),
                                [](const EdgeUse& u, const auto& e) { return std::pair(u.low, u.high) < e; });
    // The neighbour across the edge runs along it in the opposite direction. Where welding has brought four
    // triangles together at an edge, another one would belong to another sheet, and cutting it would open
    // both.
    const auto last =
        std::find_if(use, uses.end(), [&](const EdgeUse& u) { return u.low != low || u.high != high; });
    const auto opposite = [&](const EdgeUse& u) {
      return u.triangle != t && u.forward != (a < b) && !has_equal_corners(mesh_.triangles[u.triangle]);
    };
    if (const auto found = std::find_if(use, last, opposite); found != last) use = found;
    for (; use != last; ++use) {
      const std::size_t other = use->triangle;
      if (other == t || has_equal_corners(mesh_.triangles[other])) continue;
      if (gone_[other] || cut_at_[other] != kNotCut) return;  // removed in the next pass
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
      if (cut_at_[t] == kNotCut) {
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
  std::vector<bool> gone_;
  std::vector<std::uint32_t> cut_at_;  ///< vertex to cut the triangle at
  std::vector<double> longest_;        ///< longest edge of a degenerate triangle, 0 for others
  std::vector<std::size_t> cut_edge_;  ///< first corner of the edge that is cut
};

/// Removes degenerate triangles by merging their middle corner with an end of their long edge. On a smooth
/// border of close vertices every chord makes a sliver with the next two of them: cutting moves it along the
/// border for ever, and only fewer vertices end that.
class DegenerateMerge {
 public:
  DegenerateMerge(TriMesh& mesh, double length_mm)
      : mesh_(mesh), length_mm_(length_mm), around_(mesh.vertices.size()) {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      for (const std::uint32_t v : mesh_.triangles[t]) around_[v].push_back(t);
    touched_.assign(mesh_.triangles.size(), 0);
  }

  /// Returns the number of corners merged.
  std::size_t run(const std::vector<std::size_t>& flat) {
    std::size_t merged = 0;
    for (const std::size_t t : flat) {
      if (touched_[t] || has_equal_corners(mesh_.triangles[t])) continue;
      const std::size_t at = middle_corner(mesh_, t);
      const std::uint32_t middle = mesh_.triangles[t][at];
      std::uint32_t nearer = mesh_.triangles[t][(at + 1) % 3], farther = mesh_.triangles[t][(at + 2) % 3];
      const core::Vec3& place = mesh_.vertices[middle];
      if ((mesh_.vertices[farther] - place).norm() < (mesh_.vertices[nearer] - place).norm())
        std::swap(nearer, farther);
      for (const std::uint32_t end : {nearer, farther}) {
        if (!can_merge(middle, end)) continue;
        merge(middle, end);
        ++merged;
        break;
      }
    }
    std::vector<char> wanted(mesh_.triangles.size());
    for (std::size_t t = 0; t < wanted.size(); ++t) wanted[t] = !has_equal_corners(mesh_.triangles[t]);
    if (merged > 0) keep_triangles(mesh_, wanted);
    return merged;
  }

 private:
  static bool has(const std::array<std::uint32_t, 3>& t, std::uint32_t v) {
    return std::find(t.begin(), t.end(), v) != t.end();
  }

  /// The other vertices of the triangles about one, each once.
  std::vector<std::uint32_t> neighbours(std::uint32_t vertex) const {
    std::vector<std::uint32_t> found;
    for (const std::size_t t : around_[vertex])
      for (const std::uint32_t v : mesh_.triangles[t])
        if (v != vertex) found.push_back(v);
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }

  /// True when the surface is unchanged, but for rounding: the edge has two triangles, no others have
  /// both ends in reach (Dey et al. 1999, the link condition), none coincides with another afterwards, and
  /// `to` lies in the planes and on the round faces of those that move.
  bool can_merge(std::uint32_t from, std::uint32_t to) const {
    std::size_t vanish = 0;
    for (const std::size_t t : around_[from]) {
      if (touched_[t]) return false;
      if (has(mesh_.triangles[t], to))
        ++vanish;
      else if (!can_move(t, from, to))
        return false;
    }
    for (const std::size_t t : around_[to])
      if (touched_[t]) return false;
    std::vector<std::uint32_t> common;
    const std::vector<std::uint32_t> one = neighbours(from), other = neighbours(to);
    std::set_intersection(one.begin(), one.end(), other.begin(), other.end(), std::back_inserter(common));
    return vanish == 2 && common.size() == 2;
  }

  bool can_move(std::size_t triangle, std::uint32_t from, std::uint32_t to) const {
    std::array<std::uint32_t, 3> moved = mesh_.triangles[triangle];
    std::replace(moved.begin(), moved.end(), from, to);
    for (const std::size_t t : around_[to])
      if (std::is_permutation(moved.begin(), moved.end(), mesh_.triangles[t].begin())) return false;
    const auto area_vector = [this](const std::array<std::uint32_t, 3>& t) -> core::Vec3 {
      const core::Vec3& p = mesh_.vertices[t[0]];
      return (mesh_.vertices[t[1]] - p).cross(mesh_.vertices[t[2]] - p);
    };
    const std::uint32_t support = mesh_.support_of(triangle);
    if (support != kNoSupport &&
        std::abs(mesh_.supports[support].distance(mesh_.vertices[to])) > 2.0 * length_mm_)
      return false;
    const core::Vec3 before = area_vector(mesh_.triangles[triangle]);
    if (is_degenerate(mesh_, triangle, length_mm_)) return true;
    // Vertices beside a sliver of height h are up to 2 h from the line along its other half.
    const double off = before.normalized().dot(mesh_.vertices[to] - mesh_.vertices[from]);
    return std::abs(off) <= 2.0 * length_mm_ && before.dot(area_vector(moved)) > 0.0;
  }

  void merge(std::uint32_t from, std::uint32_t to) {
    for (const std::size_t t : around_[to]) touched_[t] = 1;
    for (const std::size_t t : around_[from]) {
      touched_[t] = 1;
      auto& corners = mesh_.triangles[t];
      std::replace(corners.begin(), corners.end(), from, to);
    }
  }

  TriMesh& mesh_;
  double length_mm_;
  std::vector<std::vector<std::size_t>> around_;  ///< triangles about each vertex, as they were
  std::vector<char> touched_;                     ///< triangles changed in this pass, and those beside them
};

}  // namespace

DegenerateRemoval remove_degenerate(TriMesh& mesh, double length_mm) {
  // A cut makes edges shorter, so chains of slivers end; the bound is for meshes that consist of
  // slivers, where slits no longer matter.
  constexpr int kMostPasses = 100;
  DegenerateRemoval total;
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  double shortest_mm = std::numeric_limits<double>::infinity();
  for (int pass = 0;; ++pass) {
    const std::vector<std::size_t> flat = degenerate_triangles(mesh, length_mm);
    if (flat.empty()) break;
    double length = 0.0;
    for (const std::size_t t : flat) length += longest_edge(mesh, t);
    const bool progress = flat.size() < fewest || length < shortest_mm;
    fewest = std::min(fewest, flat.size());
    shortest_mm = std::min(shortest_mm, length);
    if (!progress && pass < kMostPasses) {
      const std::size_t before = mesh.triangles.size();
      const std::size_t merged = DegenerateMerge(mesh, length_mm).run(flat);
      total.merged += merged;
      total.removed += before - mesh.triangles.size();
      if (merged > 0) continue;
    }
    DegeneratePass(mesh).run(flat, pass < kMostPasses, total);
  }
  drop_unused_vertices(mesh);
  return total;
}

}  // namespace scintray::mesh
