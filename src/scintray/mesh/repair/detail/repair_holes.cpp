#include "scintray/mesh/repair/detail/passes.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "scintray/mesh/detail/edges.hpp"

namespace scintray::mesh {
namespace {

using Loop = std::vector<std::uint32_t>;

/// An open edge in the sense of its one triangle.
struct OpenEdge {
  std::uint32_t to;
  std::uint32_t triangle;
};
using OpenEdges = std::map<std::uint32_t, std::vector<OpenEdge>>;  ///< by the vertex they start at

OpenEdges open_edges(const TriMesh& mesh) {
  OpenEdges open;
  const auto uses = sorted_edge_uses(mesh);
  for_each_edge(uses, [&](const EdgeUse* first, const EdgeUse* last) {
    if (last - first != 1) return;
    const auto [from, to] =
        first->forward ? std::pair(first->low, first->high) : std::pair(first->high, first->low);
    open[from].push_back({to, first->triangle});
  });
  return open;
}

/// Walks along open edges and takes out a loop whenever the walk meets itself.
std::vector<Loop> loops_of(OpenEdges open) {
  std::vector<Loop> loops;
  for (auto& [start, edges] : open) {
    while (!edges.empty()) {
      Loop path{start};
      std::map<std::uint32_t, std::size_t> at{{start, 0}};
      for (;;) {
        const auto next = open.find(path.back());
        if (next == open.end() || next->second.empty()) break;  // ends at a crowded edge: no loop
        const std::uint32_t to = next->second.back().to;
        next->second.pop_back();
        const auto seen = at.find(to);
        if (seen == at.end()) {
          at[to] = path.size();
          path.push_back(to);
          continue;
        }
        const auto from = path.begin() + static_cast<std::ptrdiff_t>(seen->second);
        loops.emplace_back(from, path.end());
        for (auto v = from + 1; v != path.end(); ++v) at.erase(*v);
        path.erase(from + 1, path.end());
        if (path.size() == 1) break;
      }
    }
  }
  return loops;
}

double diagonal(const TriMesh& mesh, const Loop& loop) {
  Eigen::AlignedBox3d box;
  for (const std::uint32_t v : loop) box.extend(mesh.vertices[v]);
  return box.diagonal().norm();
}

/// The mesh with its fills, by body.
class Filler {
 public:
  explicit Filler(TriMesh& mesh) : mesh_(mesh), open_(open_edges(mesh)) {
    std::size_t bodies = 0;
    body_ = connected_bodies(mesh, bodies);
    filled_.resize(bodies);
  }

  HoleFilling run(double limit_mm) {
    for (const Loop& loop : loops_of(open_)) fill(loop, limit_mm);
    undo_flat();
    for (const Defects& of_body : filled_)
      for (std::size_t i = 0; i < of_body.count; ++i)
        result_.filled.add(of_body.examples[std::min(i, of_body.examples.size() - 1)]);
    return std::move(result_);
  }

 private:
  void fill(const Loop& loop, double limit_mm) {
    const core::Vec3& place = mesh_.vertices[loop.front()];
    const double across = diagonal(mesh_, loop);
    if (across > limit_mm) {
      result_.largest_mm = std::max(result_.largest_mm, across);
      result_.too_large.add(place);
      return;
    }
    std::vector<core::Vec3> points;
    for (const std::uint32_t v : loop) points.push_back(mesh_.vertices[v]);
    const auto cover =
        loop.size() < 3 ? std::vector<std::array<std::uint32_t, 3>>{} : triangulate_hole(points);
    if (cover.empty()) {
      result_.without_cover.add(place);
      return;
    }
    const std::uint32_t beside = open_.at(loop.front()).front().triangle;
    filled_[body_[beside]].add(place);
    for (const auto& t : cover) {
      mesh_.triangles.push_back({loop[t[0]], loop[t[1]], loop[t[2]]});
      mesh_.group.push_back(mesh_.group[beside]);
      body_.push_back(body_[beside]);
    }
  }

  /// A sheet closed over its own outline is a bag without content.
  void undo_flat() {
    constexpr double kFlat = 1e-6;  // of a body's area^1.5; a cube has 0.068
    std::vector<double> volume(filled_.size()), area(filled_.size());
    std::vector<core::Vec3> origin(filled_.size(), core::Vec3::Constant(std::nan("")));
    for (std::size_t t = 0; t < body_.size(); ++t) {
      const std::uint32_t b = body_[t];
      const core::Vec3& corner = mesh_.vertices[mesh_.triangles[t][0]];
      if (origin[b].hasNaN()) origin[b] = corner;
      volume[b] += mesh_.area_vector(t).dot(corner - origin[b]) / 3.0;
      area[b] += mesh_.area_vector(t).norm();
    }
    std::vector<char> flat(filled_.size(), 0);
    for (std::size_t b = 0; b < flat.size(); ++b) {
      flat[b] = filled_[b].count > 0 && std::abs(volume[b]) <= kFlat * std::pow(area[b], 1.5);
      if (!flat[b]) continue;
      ++result_.sheets;
      filled_[b] = {};
    }
    std::vector<char> wanted(body_.size(), 1);
    for (std::size_t t = first_fill_; t < wanted.size(); ++t) wanted[t] = !flat[body_[t]];
    keep_triangles(mesh_, wanted);
  }

  TriMesh& mesh_;
  OpenEdges open_;
  std::size_t first_fill_ = mesh_.triangles.size();
  std::vector<std::uint32_t> body_;  ///< per triangle
  std::vector<Defects> filled_;      ///< by body
  HoleFilling result_;
};

}  // namespace

HoleFilling fill_holes(TriMesh& mesh, double limit_mm) { return Filler(mesh).run(limit_mm); }

}  // namespace scintray::mesh
