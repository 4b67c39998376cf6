#include "scintray/contact/detail/nesting.hpp"

#include <algorithm>
#include <optional>
#include <set>

namespace scintray::contact {

namespace {

/// Position of the surface of one body relative to another body.
struct Found {
  bool inside = false;
  bool outside = false;
  bool resolved() const { return inside && outside; }
};

/// Position of the surface of `body` relative to `other`: at its corners, at the middle of
/// its triangles, and on its edges between the places where they can pass through the other surface.
/// Two surfaces that cross always have an edge of one going through the other, so this finds every crossing;
/// the middles of triangles detect what lies between edges that run along the other's faces.
class SurfaceSampler {
 public:
  SurfaceSampler(const Body& body, const Body& other, double tolerance)
      : body_(body), other_(other), tolerance_(tolerance), seen_(body.vertices.size(), false) {}

  Found sample() {
    const Box reach = other_.box.grown(tolerance_);
    found_.outside = !reach.contains(body_.box);
    for (const std::uint32_t t : body_.tree.touching(reach)) {
      if (found_.resolved()) break;
      if (!body_.normal[t].isZero()) look_at(t);
    }
    return found_;
  }

 private:
  void look_at(std::uint32_t t) {
    look_at((body_.corner(t, 0) + body_.corner(t, 1) + body_.corner(t, 2)) / 3.0);
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t u = body_.triangles[t][k], v = body_.triangles[t][(k + 1) % 3];
      if (!seen_[u]) {
        seen_[u] = true;
        look_at(body_.vertices[u]);
      }
      if (u < v) look_along(body_.vertices[u], body_.vertices[v]);
    }
  }

  void look_at(const core::Vec3& point) {
    if (found_.resolved()) return;
    const Side side = other_.side_of(point, tolerance_);
    found_.inside = found_.inside || side == Side::inside;
    found_.outside = found_.outside || side == Side::outside;
  }

  void look_along(const core::Vec3& a, const core::Vec3& b) {
    if (found_.resolved()) return;
    std::vector<double> cuts{0.0, 1.0};
    for (const std::uint32_t t : other_.tree.touching(body_.box_of(a, b).grown(tolerance_))) {
      const core::Vec3& origin = other_.corner(t, 0);
      const double at_a = other_.normal[t].dot(a - origin), at_b = other_.normal[t].dot(b - origin);
      if ((at_a < 0.0) != (at_b < 0.0)) cuts.push_back(at_a / (at_a - at_b));
    }
    std::sort(cuts.begin(), cuts.end());
    const double length = (b - a).norm();
    for (std::size_t i = 1; i < cuts.size(); ++i)
      if ((cuts[i] - cuts[i - 1]) * length > tolerance_) look_at(a + 0.5 * (cuts[i - 1] + cuts[i]) * (b - a));
  }

  const Body& body_;
  const Body& other_;
  double tolerance_;
  std::vector<bool> seen_;
  Found found_;
};

enum class Relation { apart, a_in_b, b_in_a, overlap };

class Relations {
 public:
  explicit Relations(const std::vector<Body>& bodies) : bodies_(bodies), interior_(bodies.size()) {}

  /// @param tolerance  distance (mm) from a surface within which points are on it
  Relation of(const BodyPair& pair, double tolerance) {
    tolerance_ = tolerance;
    const Body& a = bodies_[pair.a];
    const Body& b = bodies_[pair.b];
    const core::Vec3 common = a.box.high.cwiseMin(b.box.high) - a.box.low.cwiseMax(b.box.low);
    if (common.minCoeff() <= tolerance_) return Relation::apart;
    const Found of_a = surface(a, b, pair.surfaces_near);
    if (of_a.resolved()) return Relation::overlap;
    const Found of_b = surface(b, a, pair.surfaces_near);
    if (of_b.resolved()) return Relation::overlap;
    const bool a_center_in_b = inside(pair.a, b), b_center_in_a = inside(pair.b, a);
    if (a_center_in_b && !of_a.outside && !of_b.inside && of_b.outside) return Relation::a_in_b;
    if (b_center_in_a && !of_b.outside && !of_a.inside && of_a.outside) return Relation::b_in_a;
    const bool apart = !a_center_in_b && !b_center_in_a && !of_a.inside && !of_b.inside;
    return apart ? Relation::apart : Relation::overlap;
  }

 private:
  /// Surfaces that are nowhere near each other need one query per connected piece.
  Found surface(const Body& body, const Body& other, bool near) const {
    if (near) return SurfaceSampler(body, other, tolerance_).sample();
    Found found;
    for (const std::uint32_t v : body.shells) {
      const bool in = other.side_of(body.vertices[v], 0.0) == Side::inside;
      (in ? found.inside : found.outside) = true;
    }
    return found;
  }

  bool inside(std::uint32_t body, const Body& other) {
    if (!interior_[body]) interior_[body] = bodies_[body].interior_point();
    return other.side_of(*interior_[body], 0.0) == Side::inside;
  }

  const std::vector<Body>& bodies_;
  double tolerance_ = 0.0;
  std::vector<std::optional<core::Vec3>> interior_;
};

}  // namespace

Nesting find_nesting(const std::vector<Body>& bodies, const std::vector<BodyPair>& pairs, double tolerance_mm,
                     const std::vector<double>& deviation_mm) {
  Nesting nesting;
  nesting.around.resize(bodies.size());
  Relations relations(bodies);
  for (const BodyPair& pair : pairs) {
    Relation relation = relations.of(pair, tolerance_mm);
    const double by_facets_mm = deviation_mm.empty() ? 0.0 : deviation_mm[pair.a] + deviation_mm[pair.b];
    if (relation == Relation::overlap && by_facets_mm > 0.0) {
      relation = relations.of(pair, tolerance_mm + by_facets_mm);
      if (relation != Relation::overlap) nesting.by_facets.push_back({pair.a, pair.b});
    }
    switch (relation) {
      case Relation::apart:
        break;
      case Relation::a_in_b:
        nesting.around[pair.a].push_back(pair.b);
        break;
      case Relation::b_in_a:
        nesting.around[pair.b].push_back(pair.a);
        break;
      case Relation::overlap:
        nesting.overlaps.push_back({pair.a, pair.b});
        break;
    }
  }
  // Of bodies around one body, the inner one is inside the outer one, hence deeper.
  std::vector<std::size_t> depth;
  for (const auto& around : nesting.around) depth.push_back(around.size());
  for (auto& around : nesting.around)
    std::sort(around.begin(), around.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::pair(depth[b], a) < std::pair(depth[a], b);
    });
  return nesting;
}

}  // namespace scintray::contact
