#include "scintray/mesh/repair/detail/passes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "scintray/mesh/detail/edges.hpp"
#include "scintray/mesh/weld.hpp"

namespace scintray::mesh {
namespace {

/// Disjoint sets of numbers; the smallest of a set represents it.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : root_(count) {
    std::iota(root_.begin(), root_.end(), std::size_t{0});
  }
  std::size_t find(std::size_t i) {
    while (root_[i] != i) i = root_[i] = root_[root_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) {
    const std::pair<std::size_t, std::size_t> ends = std::minmax(find(a), find(b));
    root_[ends.second] = ends.first;
  }

 private:
  std::vector<std::size_t> root_;
};

/// Pieces of surface connected through edges of two triangles: a label per triangle.
std::vector<std::uint32_t> pieces_of(const TriMesh& mesh, const std::vector<EdgeUse>& uses,
                                     std::size_t& count) {
  DisjointSets sets(mesh.triangles.size());
  for_each_edge(uses, [&](const EdgeUse* first, const EdgeUse* last) {
    if (last - first == 2) sets.join(first[0].triangle, first[1].triangle);
  });
  std::map<std::size_t, std::uint32_t> label;
  std::vector<std::uint32_t> piece;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    piece.push_back(label.try_emplace(sets.find(t), static_cast<std::uint32_t>(label.size())).first->second);
  count = label.size();
  return piece;
}

/// The angle of a triangle about its edge low -> high, counter-clockwise, in [0, 2 pi).
double angle_about(const TriMesh& mesh, const EdgeUse& use, const core::Frame& frame) {
  const auto& corners = mesh.triangles[use.triangle];
  const auto third = std::find_if(corners.begin(), corners.end(),
                                  [&](std::uint32_t v) { return v != use.low && v != use.high; });
  const core::Vec3 to = mesh.vertices[*third] - mesh.vertices[use.low];
  const double angle = std::atan2(to.dot(frame.y), to.dot(frame.x));
  return angle < 0.0 ? angle + core::kTwoPi : angle;
}

/// Uses of one edge, counter-clockwise about it. Of those at the same angle, walls that two bodies share,
/// the ones that run along the edge come first: they end a body where the others begin the next.
std::vector<EdgeUse> in_turn(const TriMesh& mesh, const std::vector<EdgeUse>& uses) {
  constexpr double kSameAngle_rad = 1e-6;
  const EdgeUse& any = uses.front();
  const core::Frame frame =
      core::Frame::about((mesh.vertices[any.high] - mesh.vertices[any.low]).normalized());
  struct Placed {
    double angle;
    EdgeUse use;
  };
  std::vector<Placed> order;
  for (const EdgeUse& use : uses) order.push_back({angle_about(mesh, use, frame), use});
  std::sort(order.begin(), order.end(), [](const Placed& a, const Placed& b) {
    return std::pair(a.angle, a.use.triangle) < std::pair(b.angle, b.use.triangle);
  });
  // Begin in a gap, so that no two at the same angle are split between both ends.
  std::size_t start = 0;
  double widest = order.front().angle + core::kTwoPi - order.back().angle;
  for (std::size_t i = 1; i < order.size(); ++i) {
    const double gap = order[i].angle - order[i - 1].angle;
    if (gap <= widest) continue;
    widest = gap;
    start = i;
  }
  std::rotate(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(start), order.end());
  for (auto begin = order.begin(), end = begin; begin != order.end(); begin = end) {
    while (end != order.end() && std::abs(end->angle - begin->angle) <= kSameAngle_rad) ++end;
    std::stable_partition(begin, end, [](const Placed& p) { return p.use.forward; });
  }
  std::vector<EdgeUse> result;
  for (const Placed& p : order) result.push_back(p.use);
  return result;
}

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// The triangles of an edge of more than two, in pairs; empty when they do not pair up.
std::optional<Pairs> pair_up(const TriMesh& mesh, const EdgeUse* first, const EdgeUse* last,
                             const std::vector<std::uint32_t>& piece) {
  Pairs pairs;
  std::map<std::uint32_t, std::vector<EdgeUse>> by_piece;
  for (const EdgeUse* use = first; use != last; ++use) by_piece[piece[use->triangle]].push_back(*use);
  std::vector<EdgeUse> rest;
  for (const auto& [id, of_piece] : by_piece) {
    if (of_piece.size() == 2 && of_piece[0].forward != of_piece[1].forward)
      pairs.emplace_back(of_piece[0].triangle, of_piece[1].triangle);
    else
      rest.insert(rest.end(), of_piece.begin(), of_piece.end());
  }
  // A triangle that runs along the edge has the solid behind it clockwise, one that runs against it
  // counter-clockwise: a wedge of the solid lies between one of the latter and the next of the former.
  if (rest.empty()) return pairs;
  if (rest.size() % 2 != 0) return std::nullopt;
  rest = in_turn(mesh, rest);
  const std::size_t start = rest[0].forward ? 1 : 0;
  for (std::size_t i = 0; i < rest.size(); i += 2) {
    const EdgeUse &a = rest[(start + i) % rest.size()], &b = rest[(start + i + 1) % rest.size()];
    if (a.forward || !b.forward) return std::nullopt;
    pairs.emplace_back(a.triangle, b.triangle);
  }
  return pairs;
}

/// Removes triangles and returns their positions.
Defects take_out(TriMesh& mesh, const std::vector<char>& unwanted) {
  Defects removed;
  std::vector<char> wanted;
  for (std::size_t t = 0; t < unwanted.size(); ++t) {
    wanted.push_back(!unwanted[t]);
    if (unwanted[t]) removed.add(centre_of(mesh, t));
  }
  keep_triangles(mesh, wanted);
  return removed;
}

}  // namespace

MeshDiagnosis edge_defects(const TriMesh& mesh) {
  MeshDiagnosis diagnosis;
  diagnosis.triangles = mesh.triangles.size();
  const auto uses = sorted_edge_uses(mesh);
  for_each_edge(uses, [&](const EdgeUse* first, const EdgeUse* last) {
    const core::Vec3 middle = 0.5 * (mesh.vertices[first->low] + mesh.vertices[first->high]);
    const auto count = last - first;
    if (count == 1) diagnosis.open_edges.add(middle);
    if (count > 2) diagnosis.nonmanifold_edges.add(middle);
    if (count == 2 && first[0].forward == first[1].forward) diagnosis.flipped_edges.add(middle);
  });
  return diagnosis;
}

Defects remove_duplicates(TriMesh& mesh) {
  std::map<std::array<std::uint32_t, 3>, std::vector<std::size_t>> by_corners;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    auto corners = mesh.triangles[t];
    std::sort(corners.begin(), corners.end());
    by_corners[corners].push_back(t);
  }
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> uses;
  for (const EdgeUse& use : sorted_edge_uses(mesh)) ++uses[{use.low, use.high}];
  std::vector<char> unwanted(mesh.triangles.size(), 0);
  for (const auto& [c, same] : by_corners) {
    if (same.size() < 2) continue;
    int odd = 0;  // edges with an odd number of triangles other than these
    for (const auto& edge : {std::pair(c[0], c[1]), std::pair(c[1], c[2]), std::pair(c[0], c[2])})
      odd += static_cast<int>((uses.at(edge) - same.size()) % 2);
    for (std::size_t i = odd >= 2 ? 1 : 0; i < same.size(); ++i) unwanted[same[i]] = 1;
  }
  return take_out(mesh, unwanted);
}

Defects remove_fins(TriMesh& mesh) {
  const auto uses = sorted_edge_uses(mesh);
  std::size_t count = 0;
  const auto piece = pieces_of(mesh, uses, count);
  std::vector<double> area(count);
  for (std::size_t t = 0; t < piece.size(); ++t) area[piece[t]] += mesh.area_vector(t).norm();
  // For every edge that is not of two triangles: the number of each piece's triangles there.
  std::vector<std::map<std::uint32_t, std::size_t>> edges;
  std::vector<std::vector<std::size_t>> edges_of(count);
  for_each_edge(uses, [&](const EdgeUse* first, const EdgeUse* last) {
    if (last - first == 2) return;
    std::map<std::uint32_t, std::size_t> pieces;
    for (const EdgeUse* use = first; use != last; ++use) ++pieces[piece[use->triangle]];
    for (const auto& entry : pieces) edges_of[entry.first].push_back(edges.size());
    edges.push_back(std::move(pieces));
  });
  const auto total = [&](std::size_t e) {
    return std::accumulate(edges[e].begin(), edges[e].end(), std::size_t{0},
                           [](std::size_t sum, const auto& entry) { return sum + entry.second; });
  };
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return area[a] < area[b]; });
  std::vector<char> gone(count, 0);
  for (const std::uint32_t p : order) {
    bool odd = false, good = true;
    for (const std::size_t e : edges_of[p]) {
      const std::size_t before = total(e), after = before - edges[e].at(p);
      odd |= before > 2 && before % 2 == 1;
      good &= after == 0 || after == 2;
    }
    if (!odd || !good) continue;
    gone[p] = 1;
    for (const std::size_t e : edges_of[p]) edges[e].erase(p);
  }
  std::vector<char> unwanted;
  for (const std::uint32_t p : piece) unwanted.push_back(gone[p]);
  return take_out(mesh, unwanted);
}

Defects part_touching_bodies(TriMesh& mesh) {
  const auto uses = sorted_edge_uses(mesh);
  std::size_t count = 0;
  const auto piece = pieces_of(mesh, uses, count);
  DisjointSets corners(3 * mesh.triangles.size());
  const auto corner = [&](std::uint32_t triangle, std::uint32_t vertex) {
    const auto& t = mesh.triangles[triangle];
    return 3 * static_cast<std::size_t>(triangle) +
           static_cast<std::size_t>(std::find(t.begin(), t.end(), vertex) - t.begin());
  };
  Defects parted;
  for_each_edge(uses, [&](const EdgeUse* first, const EdgeUse* last) {
    Pairs together;
    if (last - first > 2) {
      if (auto pairs = pair_up(mesh, first, last, piece)) {
        together = std::move(*pairs);
        parted.add(0.5 * (mesh.vertices[first->low] + mesh.vertices[first->high]));
      }
    }
    if (together.empty())
      for (const EdgeUse* use = first + 1; use != last; ++use)
        together.emplace_back(first->triangle, use->triangle);
    for (const auto& [s, t] : together)
      for (const std::uint32_t v : {first->low, first->high}) corners.join(corner(s, v), corner(t, v));
  });
  // The first set of corners at a vertex keeps it. With open edges, holes may share a vertex.
  std::vector<char> open(mesh.vertices.size(), 0);
  for_each_edge(uses, [&](const EdgeUse* first, const EdgeUse* last) {
    if (last - first == 1) open[first->low] = open[first->high] = 1;
  });
  std::map<std::size_t, std::uint32_t> vertex_of;
  std::vector<char> taken(mesh.vertices.size(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& v = mesh.triangles[t][k];
      if (v < open.size() && open[v]) continue;
      const auto [known, is_new] = vertex_of.try_emplace(corners.find(3 * t + k), v);
      if (is_new && taken[v]) {
        known->second = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(core::Vec3(mesh.vertices[v]));
      } else if (is_new) {
        taken[v] = 1;
      }
      v = known->second;
    }
  return parted;
}

}  // namespace scintray::mesh
