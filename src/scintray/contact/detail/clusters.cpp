#include "scintray/contact/detail/clusters.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "scintray/contact/box_tree.hpp"
#include "scintray/core/error.hpp"

namespace scintray::contact {

namespace {

/// Cosine above which two triangles may be two sides of one contact; the distances decide; this only
/// prevents triangles smaller than the tolerance from matching faces perpendicular to them.
constexpr double kParallel = 0.9;

/// For every triangle, its neighbours across edges.
std::vector<std::vector<std::uint32_t>> neighbours(const Body& body) {
  struct Side {
    std::uint32_t low, high, triangle;
    auto operator<=>(const Side&) const = default;
  };
  std::vector<Side> sides;
  for (std::uint32_t t = 0; t < body.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(body.triangles[t][k], body.triangles[t][(k + 1) % 3]);
      sides.push_back({low, high, t});
    }
  std::sort(sides.begin(), sides.end());
  std::vector<std::vector<std::uint32_t>> result(body.triangles.size());
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high)
      ++end;
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t j = begin; j < end; ++j)
        if (i != j) result[sides[i].triangle].push_back(sides[j].triangle);
  }
  return result;
}

/// Grows flat patches from the largest triangles; the plane is that of all triangles so far, so that
/// the rounding of one small triangle does not tilt a large face.
void add_patches(const Body& body, std::uint32_t index, double flatness_mm, Clusters& clusters) {
  constexpr std::uint32_t kNone = ~0U;
  const auto next_to = neighbours(body);
  std::vector<double> area(body.triangles.size());
  for (std::uint32_t t = 0; t < area.size(); ++t) area[t] = body.area_vector(t).norm();
  std::vector<std::uint32_t> order(area.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return area[a] > area[b]; });
  std::vector<std::uint32_t>& patch_of = clusters.patch_of[index];
  patch_of.assign(area.size(), kNone);
  for (const std::uint32_t seed : order) {
    if (patch_of[seed] != kNone) continue;
    const auto id = static_cast<std::uint32_t>(clusters.patches.size());
    Patch patch{index, {}, {}, 0.0};
    core::Vec3 sum = core::Vec3::Zero(), moment = core::Vec3::Zero();
    const core::Vec3 origin = body.corner(seed, 0);
    const auto gather = [&](std::uint32_t t) {
      patch_of[t] = id;
      patch.triangles.push_back(t);
      patch.area += area[t];
      sum += body.area_vector(t);
      for (int k = 0; k < 3; ++k) moment += area[t] / 3.0 * (body.corner(t, k) - origin);
      patch.plane = patch.area > 0.0 ? Plane{origin + moment / patch.area, sum.normalized()}
                                     : Plane{origin, core::Vec3::Zero()};
    };
    gather(seed);
    for (std::size_t i = 0; i < patch.triangles.size(); ++i)
      for (const std::uint32_t t : next_to[patch.triangles[i]]) {
        if (patch_of[t] != kNone || body.normal[t].dot(patch.plane.normal) < kParallel) continue;
        bool flat = true;
        for (int k = 0; k < 3; ++k)
          flat = flat && std::abs(patch.plane.height(body.corner(t, k))) <= flatness_mm;
        if (flat) gather(t);
      }
    clusters.patches.push_back(std::move(patch));
  }
}

double farthest(const Patch& patch, const Body& body, const Plane& plane) {
  double result = 0.0;
  for (const std::uint32_t t : patch.triangles)
    for (int k = 0; k < 3; ++k) result = std::max(result, std::abs(plane.height(body.corner(t, k))));
  return result;
}

std::vector<Vec2> clip(std::vector<Vec2> polygon, const std::array<Vec2, 3>& window) {
  const auto cross = [](const Vec2& u, const Vec2& v) { return u.x() * v.y() - u.y() * v.x(); };
  for (int k = 0; k < 3; ++k) {
    const Vec2& a = window[k];
    const Vec2 edge = window[(k + 1) % 3] - a;
    std::vector<Vec2> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec2& p = polygon[i];
      const Vec2& q = polygon[(i + 1) % polygon.size()];
      const double at_p = cross(edge, p - a), at_q = cross(edge, q - a);
      if (at_p >= 0.0) kept.push_back(p);
      if ((at_p > 0.0 && at_q < 0.0) || (at_p < 0.0 && at_q > 0.0))
        kept.push_back(p + at_p / (at_p - at_q) * (q - p));
    }
    polygon = std::move(kept);
  }
  return polygon;
}

using PatchPairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

/// Pairs of patches of different bodies that lie on each other.
PatchPairs touching_patches(const std::vector<Body>& bodies, const std::vector<BodyPair>& pairs,
                            const Clusters& clusters, double tolerance_mm) {
  PatchPairs touching;
  for (const BodyPair& pair : pairs)
    for (const auto& [ta, tb] : pair.parallel) {
      const std::uint32_t patch_a = clusters.patch_of[pair.a][ta], patch_b = clusters.patch_of[pair.b][tb];
      if (touching.contains({patch_a, patch_b})) continue;
      // Over the extent of the smaller face: a large one need not be parallel far from the contact.
      const bool a_is_larger = clusters.patches[patch_a].area >= clusters.patches[patch_b].area;
      const Plane& plane = clusters.patches[a_is_larger ? patch_a : patch_b].plane;
      const Body& small = bodies[a_is_larger ? pair.b : pair.a];
      const std::uint32_t t = a_is_larger ? tb : ta;
      bool near = true;
      for (int k = 0; k < 3; ++k) near = near && std::abs(plane.height(small.corner(t, k))) <= tolerance_mm;
      if (near && overlap(bodies[pair.a], ta, bodies[pair.b], tb, plane).width() > tolerance_mm)
        touching.insert({patch_a, patch_b});
    }
  return touching;
}

}  // namespace

std::vector<BodyPair> near_pairs(const std::vector<Body>& bodies, double reach_mm) {
  std::vector<Box> boxes;
  for (const Body& body : bodies) boxes.push_back(body.box);
  const BoxTree tree(boxes);
  std::vector<BodyPair> pairs;
  for (std::uint32_t a = 0; a < bodies.size(); ++a) {
    for (const std::uint32_t b : tree.touching(bodies[a].box.grown(reach_mm))) {
      if (b <= a) continue;
      BodyPair pair{a, b, false, {}};
      const bool a_is_finer = bodies[a].triangles.size() > bodies[b].triangles.size();
      const Body& coarse = bodies[a_is_finer ? b : a];
      const Body& fine = bodies[a_is_finer ? a : b];
      for (std::uint32_t t = 0; t < coarse.triangles.size(); ++t) {
        const Box reach = coarse.box_of(t).grown(reach_mm);
        if (!reach.overlaps(fine.box)) continue;
        for (const std::uint32_t u : fine.tree.touching(reach)) {
          pair.surfaces_near = true;
          if (std::abs(coarse.normal[t].dot(fine.normal[u])) < kParallel) continue;
          pair.parallel.push_back(a_is_finer ? std::pair(u, t) : std::pair(t, u));
        }
      }
      std::sort(pair.parallel.begin(), pair.parallel.end());
      pairs.push_back(std::move(pair));
    }
  }
  return pairs;
}

Clusters find_clusters(const std::vector<Body>& bodies, const std::vector<PlacedPart>& parts,
                       const std::vector<BodyPair>& pairs, double tolerance_mm) {
  Clusters result;
  result.patch_of.resize(bodies.size());
  for (std::uint32_t b = 0; b < bodies.size(); ++b) add_patches(bodies[b], b, 0.1 * tolerance_mm, result);
  result.cluster_of.assign(result.patches.size(), -1);

  const PatchPairs touching = touching_patches(bodies, pairs, result, tolerance_mm);
  std::map<std::uint32_t, std::vector<std::uint32_t>> contacts;
  for (const auto& [a, b] : touching) {
    contacts[a].push_back(b);
    contacts[b].push_back(a);
  }
  std::vector<std::uint32_t> order;
  for (const auto& entry : contacts) order.push_back(entry.first);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return result.patches[a].area > result.patches[b].area;
  });
  for (const std::uint32_t seed : order) {
    if (result.cluster_of[seed] >= 0) continue;
    const auto id = static_cast<std::int32_t>(result.clusters.size());
    Cluster cluster{result.patches[seed].plane, {seed}};
    result.cluster_of[seed] = id;
    for (std::size_t i = 0; i < cluster.patches.size(); ++i)
      for (const std::uint32_t next : contacts[cluster.patches[i]]) {
        const Patch& patch = result.patches[next];
        if (result.cluster_of[next] >= 0) continue;
        if (farthest(patch, bodies[patch.body], cluster.plane) > 2.0 * tolerance_mm) continue;
        result.cluster_of[next] = id;
        cluster.patches.push_back(next);
      }
    result.clusters.push_back(std::move(cluster));
  }

  core::Problems problems;
  std::set<std::pair<std::uint32_t, std::uint32_t>> reported;
  for (const auto& [a, b] : touching) {
    const std::uint32_t body_a = result.patches[a].body, body_b = result.patches[b].body;
    if (result.cluster_of[a] == result.cluster_of[b] || !reported.insert({body_a, body_b}).second) continue;
    const PlacedPart &one = parts[body_a], &other = parts[body_b];
    problems.add(one.where,
                 "faces of parts '" + one.name + "' and '" + other.name +
                     "' touch within the contact tolerance, but other faces that touch them stray from "
                     "their plane by more than twice the tolerance" +
                     also_at(other.name, other.where, one.where),
                 "lower the contact tolerance, or place the parts so that their faces share a plane");
  }
  problems.throw_if_any();
  return result;
}

Overlap overlap(const Body& a, std::uint32_t triangle_a, const Body& b, std::uint32_t triangle_b,
                const Plane& plane) {
  const core::Frame frame = core::Frame::about(plane.normal);
  const auto flat = [&](const Body& body, std::uint32_t t) {
    std::array<Vec2, 3> result;
    for (int k = 0; k < 3; ++k) {
      const core::Vec3 v = body.corner(t, k) - plane.origin;
      result[k] = {v.dot(frame.x), v.dot(frame.y)};
    }
    if (body.normal[t].dot(plane.normal) < 0.0) std::swap(result[1], result[2]);
    return result;
  };
  const auto corners = flat(a, triangle_a);
  const auto polygon = clip({corners.begin(), corners.end()}, flat(b, triangle_b));
  Overlap result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 p = polygon[i] - polygon[0], q = polygon[(i + 1) % polygon.size()] - polygon[0];
    result.area += 0.5 * (p.x() * q.y() - p.y() * q.x());
    result.perimeter += (q - p).norm();
  }
  return result;
}

}  // namespace scintray::contact
