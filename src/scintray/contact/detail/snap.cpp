#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "scintray/contact/box_tree.hpp"
#include "scintray/contact/detail/clusters.hpp"
#include "scintray/core/linear_solutions.hpp"

namespace scintray::contact {

namespace {

struct VertexOf {
  std::uint32_t body;
  std::uint32_t vertex;
  auto operator<=>(const VertexOf&) const = default;
};

/// Vertices of touching faces, each with the planes it has to lie on.
class Snapper {
 public:
  Snapper(std::vector<Body>& bodies, const Clusters& clusters, double tolerance, double rounding)
      : bodies_(bodies), clusters_(clusters), tolerance_(tolerance), rounding_(rounding) {
    gather();
    solve();
    join_corners();
    solve();
    join_edges();
    solve();
    write_back();
  }

 private:
  using Index = std::uint32_t;

  void gather() {
    std::set<std::pair<VertexOf, std::uint32_t>> uses;
    for (std::uint32_t c = 0; c < clusters_.clusters.size(); ++c)
      for (const std::uint32_t p : clusters_.clusters[c].patches) {
        const Patch& patch = clusters_.patches[p];
        for (const std::uint32_t t : patch.triangles)
          for (const std::uint32_t v : bodies_[patch.body].triangles[t]) uses.insert({{patch.body, v}, c});
      }
    in_cluster_.resize(clusters_.clusters.size());
    for (const auto& [vertex, c] : uses) {
      if (vertices_.empty() || vertices_.back() != vertex) {
        vertices_.push_back(vertex);
        planes_.emplace_back();
        index_[vertex] = static_cast<Index>(vertices_.size() - 1);
      }
      planes_.back().push_back(clusters_.clusters[c].plane);
      in_cluster_[c].push_back(static_cast<Index>(vertices_.size() - 1));
    }
    for (const VertexOf& v : vertices_) start_.push_back(bodies_[v.body].vertices[v.vertex]);
    group_.resize(vertices_.size());
    std::iota(group_.begin(), group_.end(), Index{0});
    at_ = start_;
  }

  /// The nearest point to the start of each group that lies on all its planes (least squares, and of
  /// those the least displacement; nearly parallel planes count as one).
  void solve() {
    constexpr double kRankThreshold = 1e-3;
    for (Index i = 0; i < vertices_.size(); ++i) {
      const std::vector<Plane>& planes = planes_[group_[i]];
      const core::Vec3& from = start_[group_[i]];
      double worst = 0.0;
      for (const Plane& plane : planes) worst = std::max(worst, std::abs(plane.height(from)));
      at_[i] = from;
      if (worst <= rounding_) continue;
      Eigen::MatrixXd a(planes.size(), 3);
      Eigen::VectorXd b(planes.size());
      for (std::size_t k = 0; k < planes.size(); ++k) {
        a.row(static_cast<Eigen::Index>(k)) = planes[k].normal;
        b(static_cast<Eigen::Index>(k)) = -planes[k].height(from);
      }
      at_[i] = from + core::least_solution(a, b, kRankThreshold).x;
    }
  }

  /// Corners of different bodies within the tolerance become one, at the first of them.
  void join_corners() {
    std::vector<Box> boxes;
    for (const core::Vec3& p : at_) boxes.push_back(Box{p, p});
    const BoxTree tree(boxes);
    std::vector<std::vector<Index>> members(vertices_.size());
    for (Index i = 0; i < vertices_.size(); ++i) members[i] = {i};
    for (Index i = 0; i < vertices_.size(); ++i) {
      for (const Index j : tree.touching(boxes[i].grown(tolerance_)))
        if (j > i && (at_[i] - at_[j]).norm() <= tolerance_) join(i, j, members);
    }
  }

  void join(Index i, Index j, std::vector<std::vector<Index>>& members) {
    const Index to = std::min(group_[i], group_[j]), from = std::max(group_[i], group_[j]);
    if (to == from) return;
    // Two corners of one body never become one: that would fold its surface.
    for (const Index a : members[to])
      for (const Index b : members[from])
        if (vertices_[a].body == vertices_[b].body) return;
    for (const Index b : members[from]) group_[b] = to;
    members[to].insert(members[to].end(), members[from].begin(), members[from].end());
    members[from].clear();
    planes_[to].insert(planes_[to].end(), planes_[from].begin(), planes_[from].end());
  }

  struct Edge {
    std::uint32_t body;
    Index a, b;
  };

  /// The edges of outlines that start or end at a vertex.
  using EdgesAt = std::multimap<Index, Edge>;

  /// True when `edge` attracts the vertex i. Along a common line the longer edge stays and the vertices of
  /// the shorter move; if both moved, each would go where the other was.
  bool draws(const Edge& edge, Index i, const EdgesAt& edges_at) const {
    constexpr double kSameLine = 0.99;
    const core::Vec3 along = at_[edge.b] - at_[edge.a];
    const auto [begin, end] = edges_at.equal_range(i);
    return std::none_of(begin, end, [&](const auto& entry) {
      const Edge& own = entry.second;
      const core::Vec3 own_along = at_[own.b] - at_[own.a];
      const double longer = own_along.norm() - along.norm();
      const bool stays = longer > tolerance_ || (longer >= -tolerance_ && own.body < edge.body);
      return stays && std::abs(own_along.dot(along)) > kSameLine * own_along.norm() * along.norm();
    });
  }

  std::vector<Edge> outline(const Cluster& cluster) const {
    std::vector<Edge> edges;
    for (const std::uint32_t p : cluster.patches) {
      const Patch& patch = clusters_.patches[p];
      std::set<std::pair<std::uint32_t, std::uint32_t>> open;
      for (const std::uint32_t t : patch.triangles)
        for (int k = 0; k < 3; ++k) {
          const std::uint32_t u = bodies_[patch.body].triangles[t][k];
          const std::uint32_t v = bodies_[patch.body].triangles[t][(k + 1) % 3];
          if (open.erase({v, u}) == 0) open.insert({u, v});
        }
      for (const auto& [u, v] : open)
        edges.push_back({patch.body, index_.at({patch.body, u}), index_.at({patch.body, v})});
    }
    return edges;
  }

  /// A corner within the tolerance of another body's outline has to lie on it, if the outline attracts it.
  void join_edges() {
    for (std::uint32_t c = 0; c < clusters_.clusters.size(); ++c) {
      const Cluster& cluster = clusters_.clusters[c];
      std::vector<Box> boxes;
      for (const Index i : in_cluster_[c]) boxes.push_back(Box{at_[i], at_[i]});
      const BoxTree tree(boxes);
      const std::vector<Edge> edges = outline(cluster);
      EdgesAt edges_at;
      for (const Edge& edge : edges) {
        edges_at.emplace(edge.a, edge);
        edges_at.emplace(edge.b, edge);
      }
      for (const Edge& edge : edges) {
        const core::Vec3 a = at_[edge.a], b = at_[edge.b];
        const double length = (b - a).norm();
        if (length <= tolerance_) continue;
        const core::Vec3 along = (b - a) / length;
        const Plane side{a, along.cross(cluster.plane.normal).normalized()};
        Box box;
        box.add(a);
        box.add(b);
        std::vector<Index> found;
        for (const std::uint32_t k : tree.touching(box.grown(tolerance_))) {
          const Index i = in_cluster_[c][k];
          const double t = along.dot(at_[i] - a);
          const double off = std::abs(side.height(at_[i]));
          if (vertices_[i].body != edge.body && t > tolerance_ && t < length - tolerance_ &&
              off <= tolerance_ && off > rounding_ && draws(edge, i, edges_at))
            found.push_back(i);
        }
        std::sort(found.begin(), found.end());
        for (const Index i : found) planes_[group_[i]].push_back(side);
      }
    }
  }

  void write_back() {
    std::set<std::uint32_t> moved;
    for (Index i = 0; i < vertices_.size(); ++i) {
      core::Vec3& vertex = bodies_[vertices_[i].body].vertices[vertices_[i].vertex];
      if (vertex == at_[i]) continue;
      vertex = at_[i];
      moved.insert(vertices_[i].body);
    }
    for (const std::uint32_t body : moved) bodies_[body].update();
  }

  std::vector<Body>& bodies_;
  const Clusters& clusters_;
  double tolerance_, rounding_;
  std::vector<VertexOf> vertices_;
  std::map<VertexOf, Index> index_;
  std::vector<std::vector<Plane>> planes_;  ///< by group
  std::vector<Index> group_;                ///< by vertex: the first vertex at the same place
  std::vector<std::vector<Index>> in_cluster_;
  std::vector<core::Vec3> start_, at_;
};

}  // namespace

void snap(std::vector<Body>& bodies, const Clusters& clusters, double tolerance_mm, double rounding_mm) {
  Snapper(bodies, clusters, tolerance_mm, rounding_mm);
}

}  // namespace scintray::contact
