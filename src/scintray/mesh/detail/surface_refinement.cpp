#include "scintray/mesh/detail/surface_refinement.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include "scintray/mesh/triangle_distance.hpp"

namespace scintray::mesh {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// One round of refine: measures all triangles, then halves the edges that it found.
class Round {
 public:
  Round(SurfacePatch& patch, const SurfacePoint& surface, double deviation_mm)
      : patch_(patch), surface_(surface), deviation_mm_(deviation_mm) {
    for (const Triangle& t : patch_.triangles)
      for (std::size_t side = 0; side < 3; ++side) ++edges_[edge(t, side)].triangles;
    on_border_.assign(patch_.vertices.size(), false);
    for (const auto& [ends, use] : edges_)
      if (use.triangles == 1) on_border_[ends.first] = on_border_[ends.second] = true;
  }

  /// Largest deviation, mm.
  double measure() {
    double largest = 0.0;
    for (const Triangle& t : patch_.triangles) largest = std::max(largest, measure(t));
    return largest;
  }

  bool nothing_to_halve() const {
    return std::none_of(edges_.begin(), edges_.end(), [](const auto& e) { return e.second.halve; });
  }

  void halve() {
    for (auto& [ends, use] : edges_) {
      if (!use.halve) continue;
      use.middle = static_cast<std::uint32_t>(patch_.vertices.size());
      const Eigen::Vector2d at = middle(ends.first, ends.second);
      patch_.parameters.push_back(at);
      patch_.vertices.push_back(surface_(at));
    }
    const std::vector<Triangle> before = std::exchange(patch_.triangles, {});
    for (const Triangle& t : before) split(t);
  }

 private:
  struct Use {
    int triangles = 0;
    bool halve = false;
    std::uint32_t middle = 0;
  };
  using Ends = std::pair<std::uint32_t, std::uint32_t>;

  static Ends edge(const Triangle& t, std::size_t side) { return std::minmax(t[side], t[(side + 1) % 3]); }

  double distance(const Triangle& t, const Eigen::Vector2d& at) const {
    return distance_to_triangle(surface_(at), patch_.vertices[t[0]], patch_.vertices[t[1]],
                                patch_.vertices[t[2]]);
  }

  /// Parameters of a vertex, with those of `other` where that leaves the point in its place: at a pole any
  /// longitude is right, and the one of the neighbour leads straight to it. Poles lie on the border of the
  /// parameters.
  Eigen::Vector2d parameters_towards(std::uint32_t vertex, const Eigen::Vector2d& other) const {
    constexpr double kSame_mm = 1e-7;  // CAD programs take points that close for one
    Eigen::Vector2d at = patch_.parameters[vertex];
    for (int axis = 0; axis < 2 && on_border_[vertex]; ++axis) {
      Eigen::Vector2d moved = at;
      moved[axis] = other[axis];
      if (moved == at) continue;
      if ((surface_(moved) - patch_.vertices[vertex]).norm() <= kSame_mm) at = moved;
    }
    return at;
  }

  Eigen::Vector2d middle(std::uint32_t a, std::uint32_t b) const {
    return 0.5 * (parameters_towards(a, patch_.parameters[b]) + parameters_towards(b, patch_.parameters[a]));
  }

  Eigen::Vector2d middle(const Triangle& t) const {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (std::size_t corner = 0; corner < 3; ++corner)
      sum += parameters_towards(t[corner], middle(t[(corner + 1) % 3], t[(corner + 2) % 3]));
    return sum / 3.0;
  }

  double measure(const Triangle& t) {
    double largest = 0.0;
    for (std::size_t side = 0; side < 3; ++side) {
      const double off = distance(t, middle(t[side], t[(side + 1) % 3]));
      Use& use = edges_[edge(t, side)];
      if (off > deviation_mm_ && use.triangles > 1) use.halve = true;
      largest = std::max(largest, off);
    }
    const double off = distance(t, middle(t));
    if (off > deviation_mm_) halve_longest(t);
    return std::max(largest, off);
  }

  void halve_longest(const Triangle& t) {
    Use* longest = nullptr;
    double length = 0.0;
    for (std::size_t side = 0; side < 3; ++side) {
      Use& use = edges_[edge(t, side)];
      const double own = (patch_.vertices[t[side]] - patch_.vertices[t[(side + 1) % 3]]).norm();
      if (use.triangles > 1 && own > length) {
        longest = &use;
        length = own;
      }
    }
    if (longest) longest->halve = true;
  }

  /// Splits at the first halved edge, and then the two parts: their common edge is new and is not halved.
  void split(const Triangle& t) {
    for (std::size_t side = 0; side < 3; ++side) {
      const auto found = edges_.find(edge(t, side));
      if (found == edges_.end() || !found->second.halve) continue;
      const std::uint32_t from = t[side], to = t[(side + 1) % 3], tip = t[(side + 2) % 3];
      split({from, found->second.middle, tip});
      split({found->second.middle, to, tip});
      return;
    }
    patch_.triangles.push_back(t);
  }

  SurfacePatch& patch_;
  const SurfacePoint& surface_;
  double deviation_mm_;
  std::map<Ends, Use> edges_;
  std::vector<bool> on_border_;  ///< by vertex
};

}  // namespace

double refine(SurfacePatch& patch, const SurfacePoint& surface, double deviation_mm) {
  constexpr int kMostRounds = 20;
  constexpr std::size_t kMostTriangles = 4'000'000;
  for (int round = 0;; ++round) {
    Round pass(patch, surface, deviation_mm);
    const double largest = pass.measure();
    if (round == kMostRounds || patch.triangles.size() > kMostTriangles || pass.nothing_to_halve())
      return largest;
    pass.halve();
  }
}

}  // namespace scintray::mesh
