#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <queue>
#include <set>
#include <tuple>

#include "scintray/core/activity.hpp"
#include "scintray/mesh/detail/cgal_checks.hpp"
#include "scintray/mesh/repair/detail/passes.hpp"
#include "scintray/mesh/triangle_distance.hpp"
#include "scintray/mesh/weld.hpp"

namespace scintray::mesh {
namespace {

using Corners = std::array<std::uint32_t, 3>;
using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// Holes of more corners are closed by a fan: the time of a cover grows faster than their square.
constexpr std::size_t kLargestCover = 48;
/// Triangles around a hole whose corners have more are not all compared with its cover before it is taken.
constexpr std::size_t kWholeStar = 24;
constexpr int kMostRemovalRounds = 24;
/// Where less than half of the crossings are gone after these, two sheets run through each other.
constexpr int kRoundsToHalve = 3;

bool has(const Corners& corners, std::uint32_t vertex) {
  return std::find(corners.begin(), corners.end(), vertex) != corners.end();
}

/// What replaces the triangles around a vertex.
struct Cover {
  std::vector<Corners> triangles;
  std::vector<std::uint32_t> group;
  std::optional<core::Vec3> centre;  ///< of a fan, whose corner it is by the number of the next vertex
};

/// Removal of vertices, one after another, until no triangles cross.
class CrossingRemover {
 public:
  CrossingRemover(TriMesh mesh, Pairs crossings)
      : mesh_(std::move(mesh)), crossings_(std::move(crossings)), rounding_(rounding_length(mesh_)) {
    mesh_.group.resize(mesh_.triangles.size(), 0);
    alive_.assign(mesh_.triangles.size(), 1);
    around_.resize(mesh_.vertices.size());
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t)
      for (const std::uint32_t v : mesh_.triangles[t]) around_[v].push_back(t);
  }

  CrossFree run() {
    const std::size_t first = crossings_.size(), original = mesh_.triangles.size();
    // More is no local defect, and the body that is left would be another one.
    const std::size_t most_left_out = std::max<std::size_t>(64, mesh_.vertices.size() / 20);
    const std::size_t most_crossings = std::max<std::size_t>(2000, mesh_.triangles.size() / 20);
    for (int round = 0; first <= most_crossings && round < kMostRemovalRounds && !crossings_.empty();
         ++round) {
      core::report_activity("repairing: triangles that cross", first - std::min(first, crossings_.size()),
                            first);
      const std::size_t before = left_out_.size();
      remove_some();
      if (left_out_.size() == before || left_out_.size() > most_left_out) break;
      if (round == kRoundsToHalve && crossings_.size() > first / 2) break;
    }
    result_.remaining = crossings_.size();
    for (const core::Vec3& place : left_out_) result_.left_out.add(place);
    result_.farthest_mm = farthest_from_new(original);
    keep_triangles(mesh_, alive_);
    drop_unused_vertices(mesh_);
    result_.mesh = std::move(mesh_);
    return std::move(result_);
  }

 private:
  /// One round: vertices whose triangles do not touch new ones, those in most crossings first.
  void remove_some() {
    first_new_ = static_cast<std::uint32_t>(mesh_.triangles.size());
    of_vertex_.clear();
    partners_.clear();
    for (std::uint32_t i = 0; i < crossings_.size(); ++i) {
      const auto [s, t] = crossings_[i];
      partners_[s].push_back(t);
      partners_[t].push_back(s);
      std::set<std::uint32_t> corners(mesh_.triangles[s].begin(), mesh_.triangles[s].end());
      corners.insert(mesh_.triangles[t].begin(), mesh_.triangles[t].end());
      for (const std::uint32_t v : corners) of_vertex_[v].push_back(i);
    }
    open_.assign(crossings_.size(), 1);
    const std::size_t before = left_out_.size();
    pass({});
    const auto stuck = [&] { return left_out_.size() == before; };
    if (stuck()) {
      tried_.clear();
      pass({});
    }
    // A step that leaves crossings may make others possible.
    if (stuck()) pass({.clean = false, .large = false});
    if (stuck()) pass({.clean = false});
    std::vector<std::uint32_t> added;
    for (auto t = first_new_; t < mesh_.triangles.size(); ++t) added.push_back(t);
    Pairs left;
    for (const auto& pair : crossings_)
      if (alive_[pair.first] && alive_[pair.second]) left.push_back(pair);
    for (const auto& pair : crossings_with(mesh_, added, alive_)) left.push_back(pair);
    std::sort(left.begin(), left.end());
    crossings_ = std::move(left);
  }

  std::size_t open_crossings(std::uint32_t v) const {
    const auto& own = of_vertex_.at(v);
    return static_cast<std::size_t>(
        std::count_if(own.begin(), own.end(), [&](std::uint32_t i) { return open_[i] != 0; }));
  }

  struct Pass {
    bool clean = true;  ///< only covers that cross nothing near them; else one vertex, whatever its cover
    bool large = true;  ///< vertices of more than kLargestCover edges, too
  };

  void pass(const Pass& allowed) {
    struct Candidate {
      std::size_t crossings;
      double from_neighbours;
      std::uint32_t vertex;
      bool operator<(const Candidate& other) const {
        return std::tuple(crossings, -from_neighbours, other.vertex) <
               std::tuple(other.crossings, -other.from_neighbours, vertex);
      }
    };
    std::priority_queue<Candidate> queue;
    for (const auto& entry : of_vertex_)
      queue.push({open_crossings(entry.first), distance_to_neighbours(entry.first), entry.first});
    while (!queue.empty()) {
      Candidate next = queue.top();
      queue.pop();
      const std::size_t now = open_crossings(next.vertex);
      if (now == 0) continue;
      if (now < next.crossings) {
        next.crossings = now;
        queue.push(next);
        continue;
      }
      // The cover of many corners takes long to try, and crosses itself until the defects on its outline are
      // removed.
      if (around_[next.vertex].size() > kLargestCover &&
          (!allowed.large || (allowed.clean && !tried_.insert(next.vertex).second)))
        continue;
      if (!remove(next.vertex, allowed.clean)) continue;
      for (const std::uint32_t i : of_vertex_.at(next.vertex))
        if (!alive_[crossings_[i].first] || !alive_[crossings_[i].second]) open_[i] = 0;
      if (!allowed.clean) return;
    }
  }

  core::Vec3 mean_of(const std::vector<std::uint32_t>& corners) const {
    core::Vec3 sum = core::Vec3::Zero();
    for (const std::uint32_t v : corners) sum += mesh_.vertices[v];
    return sum / static_cast<double>(corners.size());
  }

  double distance_to_neighbours(std::uint32_t v) const {
    std::vector<std::uint32_t> corners;
    for (const std::uint32_t t : around_[v])
      for (const std::uint32_t w : mesh_.triangles[t])
        if (w != v) corners.push_back(w);
    return (mesh_.vertices[v] - mean_of(corners)).norm();
  }

  bool remove(std::uint32_t v, bool clean) {
    for (const std::uint32_t t : around_[v])
      if (t >= first_new_) return false;  // in the next round
    const std::vector<std::uint32_t> outline = outline_around(v);
    if (outline.size() < 3) return false;
    const auto try_cover = [&](const Cover& cover) {
      ++result_.covers_tried;
      if (cover.triangles.empty() || !fits(v, cover) || (clean && crosses(v, outline, cover))) return false;
      take(v, cover);
      return true;
    };
    if (outline.size() <= kLargestCover && try_cover(flat_cover(v, outline))) return true;
    return try_cover(fan(v, outline));
  }

  std::uint32_t corner_after(std::uint32_t t, std::uint32_t v) const {
    const Corners& corners = mesh_.triangles[t];
    return corners[(static_cast<std::size_t>(std::find(corners.begin(), corners.end(), v) - corners.begin()) +
                    1) %
                   3];
  }

  /// The corners around a vertex in the sense of its triangles; empty when they do not go around it once.
  std::vector<std::uint32_t> outline_around(std::uint32_t v) const {
    std::map<std::uint32_t, std::uint32_t> next;
    for (const std::uint32_t t : around_[v]) {
      const std::uint32_t from = corner_after(t, v);
      if (!next.emplace(from, corner_after(t, from)).second) return {};
    }
    if (next.empty()) return {};
    std::vector<std::uint32_t> outline;
    std::uint32_t at = next.begin()->first;
    do {
      outline.push_back(at);
      const auto found = next.find(at);
      if (found == next.end()) return {};
      at = found->second;
    } while (at != outline.front() && outline.size() <= next.size());
    return at == outline.front() && outline.size() == next.size() ? outline : std::vector<std::uint32_t>{};
  }

  /// The group of the triangle around `v` that has one of the sides of `corners`; else of the first.
  std::uint32_t group_beside(std::uint32_t v, const Corners& corners) const {
    for (const std::uint32_t t : around_[v]) {
      int common = 0;
      for (const std::uint32_t w : mesh_.triangles[t]) common += w != v && has(corners, w) ? 1 : 0;
      if (common == 2) return mesh_.group[t];
    }
    return mesh_.group[around_[v].front()];
  }

  /// True when a triangle that does not have `v` has both vertices.
  bool joined_already(std::uint32_t v, std::uint32_t from, std::uint32_t to) const {
    const auto& fewer = around_[from].size() < around_[to].size() ? around_[from] : around_[to];
    return std::any_of(fewer.begin(), fewer.end(), [&](std::uint32_t t) {
      const Corners& corners = mesh_.triangles[t];
      return has(corners, from) && has(corners, to) && !has(corners, v);
    });
  }

  /// Triangles between the corners of the outline, none of whose edges is in the mesh already.
  Cover flat_cover(std::uint32_t v, const std::vector<std::uint32_t>& outline) const {
    std::vector<core::Vec3> points;
    for (const std::uint32_t w : outline) points.push_back(mesh_.vertices[w]);
    const auto joined = [&](std::size_t i, std::size_t j) {
      return joined_already(v, outline[i], outline[j]);
    };
    Cover cover;
    for (const auto& [i, k, j] : triangles_of_least_area(points, rounding_, joined)) {
      cover.triangles.push_back({outline[i], outline[k], outline[j]});
      cover.group.push_back(group_beside(v, cover.triangles.back()));
    }
    return cover;
  }

  /// The same triangles around the mean of the outline, weighted by the length of its sides.
  Cover fan(std::uint32_t v, const std::vector<std::uint32_t>& outline) const {
    core::Vec3 sum = core::Vec3::Zero();
    double length = 0.0;
    const auto centre = static_cast<std::uint32_t>(mesh_.vertices.size());
    Cover cover;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const std::uint32_t from = outline[i], to = outline[(i + 1) % outline.size()];
      const core::Vec3 &a = mesh_.vertices[from], &b = mesh_.vertices[to];
      sum += 0.5 * (a - b).norm() * (a + b);
      length += (a - b).norm();
      cover.triangles.push_back({from, to, centre});
    }
    cover.centre = sum / length;
    if ((*cover.centre - mesh_.vertices[v]).norm() <= rounding_) return {};
    std::map<std::uint32_t, std::uint32_t> group;  // by the first corner of a side
    for (const std::uint32_t t : around_[v]) group[corner_after(t, v)] = mesh_.group[t];
    for (const std::uint32_t from : outline) cover.group.push_back(group.at(from));
    return cover;
  }

  core::Vec3 point(std::uint32_t v, const Cover& cover) const {
    return v < mesh_.vertices.size() ? mesh_.vertices[v] : *cover.centre;
  }

  /// True when every triangle of a fan has an area. Of a hole with three corners, its one triangle is not
  /// there yet.
  bool fits(std::uint32_t v, const Cover& cover) const {
    if (cover.triangles.size() == 1) {
      const Corners& own = cover.triangles.front();
      return std::none_of(around_[own[0]].begin(), around_[own[0]].end(), [&](std::uint32_t t) {
        const Corners& corners = mesh_.triangles[t];
        return !has(corners, v) && has(corners, own[1]) && has(corners, own[2]);
      });
    }
    return std::all_of(cover.triangles.begin(), cover.triangles.end(), [&](const Corners& corners) {
      const core::Vec3 a = point(corners[0], cover), b = point(corners[1], cover),
                       c = point(corners[2], cover);
      const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
      return (b - a).cross(c - a).norm() > 2.0 * rounding_ * longest;
    });
  }

  /// True when the cover crosses itself or a triangle around it, or one that those crossed which it replaces.
  bool crosses(std::uint32_t v, const std::vector<std::uint32_t>& outline, const Cover& cover) const {
    std::set<std::uint32_t> near;
    const auto consider = [&](std::uint32_t t) {
      if (alive_[t] && !has(mesh_.triangles[t], v)) near.insert(t);
    };
    for (const std::uint32_t t : around_[v]) {
      const auto found = partners_.find(t);
      if (found == partners_.end()) continue;
      for (const std::uint32_t partner : found->second) consider(partner);
    }
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const std::uint32_t w = outline[i], after = outline[(i + 1) % outline.size()];
      const bool whole = around_[w].size() <= kWholeStar;
      const auto& fewer = around_[w].size() <= around_[after].size() ? around_[w] : around_[after];
      if (whole)
        for (const std::uint32_t t : around_[w]) consider(t);
      for (const std::uint32_t t : fewer)
        if (has(mesh_.triangles[t], w) && has(mesh_.triangles[t], after)) consider(t);
    }
    TriMesh part;
    std::map<std::uint32_t, std::uint32_t> number;
    const auto add = [&](const Corners& corners) {
      Corners own{};
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [entry, added] =
            number.emplace(corners[k], static_cast<std::uint32_t>(part.vertices.size()));
        if (added) part.vertices.push_back(point(corners[k], cover));
        own[k] = entry->second;
      }
      part.triangles.push_back(own);
    };
    for (const Corners& corners : cover.triangles) add(corners);
    for (const std::uint32_t t : near) add(mesh_.triangles[t]);
    std::vector<std::uint32_t> covers(cover.triangles.size());
    for (std::uint32_t t = 0; t < covers.size(); ++t) covers[t] = t;
    return !crossings_with(part, covers, std::vector<char>(part.triangles.size(), 1)).empty();
  }

  void take(std::uint32_t v, const Cover& cover) {
    left_out_.push_back(mesh_.vertices[v]);
    const std::vector<std::uint32_t> gone = around_[v];
    for (const std::uint32_t t : gone) {
      alive_[t] = 0;
      for (const std::uint32_t w : mesh_.triangles[t]) {
        auto& list = around_[w];
        list.erase(std::find(list.begin(), list.end(), t));
      }
    }
    if (cover.centre) {
      mesh_.vertices.push_back(*cover.centre);
      around_.emplace_back();
    }
    for (std::size_t i = 0; i < cover.triangles.size(); ++i) {
      const auto t = static_cast<std::uint32_t>(mesh_.triangles.size());
      mesh_.triangles.push_back(cover.triangles[i]);
      mesh_.group.push_back(cover.group[i]);
      alive_.push_back(1);
      for (const std::uint32_t w : cover.triangles[i]) around_[w].push_back(t);
    }
  }

  /// The largest distance of a vertex that was left out from the triangles that are new (mm).
  double farthest_from_new(std::size_t original) const {
    double farthest = 0.0;
    for (const core::Vec3& place : left_out_) {
      double nearest = std::numeric_limits<double>::infinity();
      for (std::size_t t = original; t < mesh_.triangles.size(); ++t) {
        if (!alive_[t]) continue;
        const auto& [a, b, c] = mesh_.triangles[t];
        const core::Vec3 &p = mesh_.vertices[a], &q = mesh_.vertices[b], &r = mesh_.vertices[c];
        const core::Vec3 low = p.cwiseMin(q).cwiseMin(r), high = p.cwiseMax(q).cwiseMax(r);
        if ((low - place).cwiseMax(place - high).maxCoeff() >= nearest) continue;
        nearest = std::min(nearest, distance_to_triangle(place, p, q, r));
      }
      if (std::isfinite(nearest)) farthest = std::max(farthest, nearest);
    }
    return farthest;
  }

  TriMesh mesh_;
  Pairs crossings_;
  double rounding_;
  std::vector<char> alive_;
  std::vector<std::vector<std::uint32_t>> around_;  ///< triangles of each vertex that are alive
  std::uint32_t first_new_ = 0;                     ///< first triangle of this round
  std::map<std::uint32_t, std::vector<std::uint32_t>> of_vertex_;  ///< crossings of triangles with a vertex
  std::map<std::uint32_t, std::vector<std::uint32_t>> partners_;   ///< triangles that a triangle crosses
  std::vector<char> open_;                                         ///< crossings of this round that remain
  std::set<std::uint32_t> tried_;  ///< vertices of many edges whose cover crossed something
  std::vector<core::Vec3> left_out_;
  CrossFree result_;
};

}  // namespace

CrossFree without_crossings(TriMesh mesh, Pairs crossings) {
  return CrossingRemover(std::move(mesh), std::move(crossings)).run();
}

}  // namespace scintray::mesh
