#include "scintray/scene/detail/round_parts.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

namespace scintray::scene {

namespace {

/// Limits of a convex body; more are faster by a tree of faces, or by Embree.
constexpr std::size_t kMostFlatFaces = 32, kMostRoundFaces = 8;
/// Limits of any other body.
constexpr std::size_t kMostTrimmedFlatFaces = 512, kMostTrimmedRoundFaces = 8192;
/// Distance from a surface within which corners are on it, in contact tolerances: contacts move them.
constexpr double kOnSurface = 4.0;
/// A triangle of a part's boundary, in world coordinates, outwards.
struct PartTriangle {
  Corners corners;
  std::uint32_t support;
  bool own;  ///< of the part's mesh; not of an interface, which may cut facets where they are off the surface
};

/// The triangles of every part: those of its interfaces, whose corners have moved into contact, then its own.
core::IdVector<core::PartId, std::vector<PartTriangle>> triangles_of_parts(
    const Assembly& assembly, const std::vector<contact::InterfaceTriangle>& triangles) {
  core::IdVector<core::PartId, std::vector<PartTriangle>> result(assembly.parts.size());
  for (const contact::InterfaceTriangle& t : triangles) {
    if (t.back_face.has_value()) result[t.back].push_back({t.vertex, t.back_support, false});
    if (t.front_face.has_value())
      result[t.front].push_back({{t.vertex[0], t.vertex[2], t.vertex[1]}, t.front_support, false});
  }
  for (const core::PartId part : assembly.parts.ids()) {
    const auto by_area = [](const PartTriangle& a, const PartTriangle& b) {
      return doubled_area(a.corners).squaredNorm() > doubled_area(b.corners).squaredNorm();
    };
    std::stable_sort(result[part].begin(), result[part].end(), by_area);
    const contact::PlacedPart& own = assembly.parts[part].geometry;
    for (std::size_t t = 0; t < own.triangles.size(); ++t) {
      const auto& [a, b, c] = own.triangles[t];
      result[part].push_back({{own.vertices[a], own.vertices[b], own.vertices[c]},
                              own.support.empty() ? mesh::kNoSupport : own.support[t],
                              true});
    }
  }
  return result;
}

/// Recognition of one part as a body.
class BodyFinder {
 public:
  BodyFinder(const contact::PlacedPart& part, const std::vector<PartTriangle>& triangles, double tolerance_mm)
      : part_(part), triangles_(triangles), tolerance_(kOnSurface * tolerance_mm) {}

  PartBody find() {
    PartBody body;
    body.quadrics = part_.supports;
    for (const PartTriangle& t : triangles_)
      if (t.support != mesh::kNoSupport)
        body.deviation_mm = std::max(body.deviation_mm,
                                     mesh::facet_deviation(body.quadrics[t.support], t.corners).distance_mm);
    body.off_surface_mm = tolerance_;
    body.corners = part_.vertices;
    std::string reason = find_planes(body);
    if (reason.empty()) body.convex = is_convex(body);
    if (reason.empty() && !body.convex && !body.quadrics.empty())
      reason = find_trimmed_faces(part_, tolerance_, body);
    body.round = body.is_exact() && !body.quadrics.empty();
    if (!body.quadrics.empty()) body.facets_because = reason;
    return body;
  }

 private:
  bool on(const WorldPlane& plane, const Corners& corners) const {
    return std::all_of(corners.begin(), corners.end(), [&](const core::Vec3& corner) {
      return std::abs(plane.normal.dot(corner) - plane.offset) <= tolerance_;
    });
  }

  std::string find_planes(PartBody& body) const {
    const std::size_t most = body.quadrics.empty() ? kMostFlatFaces : kMostTrimmedFlatFaces;
    if (body.quadrics.size() > kMostTrimmedRoundFaces) return "it has more than 8192 round faces";
    for (const PartTriangle& t : triangles_) {
      if (t.support != mesh::kNoSupport) continue;
      const core::Vec3 area = doubled_area(t.corners);
      if (area.isZero(0.0)) continue;
      const core::Vec3 normal = area.normalized();
      const bool known = std::any_of(body.planes.begin(), body.planes.end(), [&](const WorldPlane& plane) {
        return plane.normal.dot(normal) > 0.0 && on(plane, t.corners);
      });
      if (known) continue;
      if (body.planes.size() == most) return "it has more than 512 flat faces";
      body.planes.push_back({normal, normal.dot(t.corners[0])});
    }
    return {};
  }

  /// Whether the part is the intersection of the insides of its surfaces.
  bool is_convex(const PartBody& body) const {
    if (body.planes.size() > kMostFlatFaces || body.quadrics.size() > kMostRoundFaces) return false;
    for (const mesh::SupportSurface& quadric : body.quadrics)
      if (!quadric.is_convex()) return false;
    for (const PartTriangle& t : triangles_) {
      for (const core::Vec3& corner : t.corners) {
        for (const WorldPlane& plane : body.planes)
          if (plane.normal.dot(corner) > plane.offset + tolerance_) return false;
        for (const mesh::SupportSurface& quadric : body.quadrics)
          if (quadric.distance(corner) > tolerance_) return false;
        if (t.own && t.support != mesh::kNoSupport &&
            std::abs(body.quadrics[t.support].distance(corner)) > tolerance_)
          return false;
      }
      if (t.support == mesh::kNoSupport) continue;
      const core::Vec3 middle = (t.corners[0] + t.corners[1] + t.corners[2]) / 3.0;
      if (body.quadrics[t.support].gradient(middle).dot(doubled_area(t.corners)) < 0.0) return false;
    }
    return true;
  }

  const contact::PlacedPart& part_;
  const std::vector<PartTriangle>& triangles_;
  double tolerance_;
};

/// Leaves facets to parts whose round faces touch a face that is not the same surface, exact on both sides.
void match_contacts(const Assembly& assembly, const std::vector<contact::InterfaceTriangle>& triangles,
                    PartBodies& bodies) {
  const double tolerance = kOnSurface * assembly.contact_tolerance_mm;
  const auto quadric = [&](core::PartId part, std::uint32_t support) -> const mesh::SupportSurface* {
    return support == mesh::kNoSupport || !bodies[part].round ? nullptr : &bodies[part].quadrics[support];
  };
  const auto leave_facets = [&](core::PartId part, core::PartId other) {
    bodies[part].leave_facets("it touches facets of \"" + assembly.parts[other].geometry.name + "\"");
  };
  for (bool changed = true; changed;) {
    changed = false;
    for (const contact::InterfaceTriangle& t : triangles) {
      if (!t.back_face.has_value() || !t.front_face.has_value()) continue;
      const mesh::SupportSurface* const back = quadric(t.back, t.back_support);
      const mesh::SupportSurface* const front = quadric(t.front, t.front_support);
      if ((!back && !front) || (back && front && back->agrees_with(*front, t.vertex, tolerance))) continue;
      if (back) leave_facets(t.back, t.front);
      if (front) leave_facets(t.front, t.back);
      changed = true;
    }
  }
}

/// Leaves facets to parts whose exact surface would extend into what their facets stay clear of: the facets
/// of another part, or another exact body.
class ClearanceCheck {
 public:
  ClearanceCheck(const Assembly& assembly, const std::vector<contact::InterfaceTriangle>& triangles,
                 PartBodies& bodies)
      : assembly_(assembly),
        triangles_(triangles),
        bodies_(bodies),
        tolerance_(kOnSurface * assembly.contact_tolerance_mm) {}

  /// @return whether a part was changed
  bool run() {
    collect();
    for (const auto& [region, content] : regions_)
      for (const core::PartId part : content.round)
        if (bodies_[part].round) compare(region, content, part);
    return changed_;
  }

 private:
  struct RegionContent {
    std::set<core::PartId> round;        ///< bodies cut out of it
    std::vector<std::size_t> triangles;  ///< of other parts' facets
  };
  struct Samples {
    Eigen::AlignedBox3d box;
    std::vector<core::Vec3> points;  ///< of the exact faces, inwards by the tolerance
  };

  void collect() {
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      const contact::InterfaceTriangle& t = triangles_[i];
      add(t.back, t.back_face.has_value() ? t.back : t.front, i);
      add(t.front, t.front_face.has_value() ? t.front : t.back, i);
    }
  }
  void add(core::PartId region, core::PartId body, std::size_t triangle) {
    if (body != region && bodies_[body].round)
      regions_[region].round.insert(body);
    else if (!on_exact_body(bodies_, region, body))
      regions_[region].triangles.push_back(triangle);
  }

  const Samples& samples(core::PartId part) {
    const auto [known, is_new] = samples_.try_emplace(part);
    if (!is_new) return known->second;
    Samples& result = known->second;
    const contact::PlacedPart& own = assembly_.parts[part].geometry;
    for (const core::Vec3& vertex : own.vertices) result.box.extend(vertex);
    for (std::size_t t = 0; t < own.triangles.size(); ++t) {
      if (own.support[t] == mesh::kNoSupport) continue;
      const mesh::SupportSurface& surface = own.supports[own.support[t]];
      const auto& [a, b, c] = own.triangles[t];
      const core::Vec3 &va = own.vertices[a], &vb = own.vertices[b], &vc = own.vertices[c];
      for (const core::Vec3& on_facet : {core::Vec3((va + vb + vc) / 3.0), core::Vec3(0.5 * (va + vb)),
                                         core::Vec3(0.5 * (vb + vc)), core::Vec3(0.5 * (vc + va))}) {
        core::Vec3 point = on_facet;
        for (int step = 0; step < 3; ++step) point += surface.correction(point);
        const bool wall = surface.gradient(point).dot(doubled_area({va, vb, vc})) < 0.0;
        point -= (wall ? -tolerance_ : tolerance_) * surface.normal(point);
        result.points.push_back(point);
        result.box.extend(point);
      }
    }
    return result;
  }

  /// Whether a point is inside a part, or by less than the margin (mm) outside; for a negative margin, by
  /// more than that inside.
  bool contains(core::PartId part, const core::Vec3& point, double margin) {
    const PartBody& body = bodies_[part];
    if (!body.faces.empty()) {
      const auto [alone, is_new] = alone_.try_emplace(part);
      if (is_new) alone->second = part_alone(body);
      const ExactBodies& exact = alone->second;
      const bool inside = exact.contains(exact.bodies.front(), point);
      if (margin == 0.0 || inside == (margin > 0.0)) return inside;
      return (exact.distance_to_faces(exact.bodies.front(), point) <= std::abs(margin)) == (margin > 0.0);
    }
    return std::all_of(
               body.planes.begin(), body.planes.end(),
               [&](const WorldPlane& plane) { return plane.normal.dot(point) <= plane.offset + margin; }) &&
           std::all_of(body.quadrics.begin(), body.quadrics.end(),
                       [&](const mesh::SupportSurface& s) { return s.distance(point) <= margin; });
  }

  void compare(core::PartId region, const RegionContent& content, core::PartId part) {
    const Samples& own = samples(part);
    if (region.has_value() && bodies_[region].is_exact()) {
      for (const core::Vec3& point : own.points)
        if (!contains(region, point, 0.0)) return leave_facets(part, region);
    }
    for (const core::PartId other : content.round) {
      if (other == part || !bodies_[other].round || !samples(other).box.intersects(own.box)) continue;
      // Inwards by the tolerance once more, for bodies that touch; nested ones that share an end are apart.
      const bool within = std::any_of(own.points.begin(), own.points.end(), [&](const core::Vec3& point) {
        return contains(other, point, -tolerance_);
      });
      if (within && !is_around(other, part)) return leave_facets(part, other);
    }
    for (const std::size_t i : content.triangles) {
      const contact::InterfaceTriangle& t = triangles_[i];
      Eigen::AlignedBox3d box;
      for (const core::Vec3& corner : t.vertex) box.extend(corner);
      if (!box.intersects(own.box)) continue;
      const Corners inwards =
          t.back == region ? Corners{t.vertex[0], t.vertex[2], t.vertex[1]} : t.vertex;  // towards the region
      if (!collides(t.vertex, part) && !extends_beyond(inwards, own.points, part)) continue;
      return leave_facets(part, t.back_face.has_value() && t.back != part ? t.back : t.front);
    }
  }

  /// Whether all of the inner body's faces are inside the outer.
  bool is_around(core::PartId outer, core::PartId inner) {
    const std::vector<core::Vec3>& points = samples(inner).points;
    return std::all_of(points.begin(), points.end(),
                       [&](const core::Vec3& point) { return contains(outer, point, tolerance_); });
  }

  /// Whether the part, of which the facets do not intersect a triangle, bulges through it. The triangle's
  /// normal points into the region of the part.
  bool extends_beyond(const Corners& triangle, const std::vector<core::Vec3>& points, core::PartId part) {
    const core::Vec3 normal = doubled_area(triangle);
    const double reach = 2.0 * bodies_[part].deviation_mm + tolerance_;
    return std::any_of(points.begin(), points.end(), [&](const core::Vec3& point) {
      const double height = normal.dot(point - triangle[0]) / normal.norm();
      if (!(height < -tolerance_) || height < -reach) return false;
      for (std::size_t k = 0; k < 3; ++k) {  // not at its sides, where other faces begin
        const core::Vec3 side = triangle[(k + 1) % 3] - triangle[k];
        const double within = normal.dot(side.cross(point - triangle[k])) / (normal.norm() * side.norm());
        if (!(within > 2.0 * tolerance_)) return false;
      }
      return contains(part, point, 0.0);  // and not beyond the end of the face that its facet has
    });
  }

  /// Whether a triangle extends into the part by more than the tolerance.
  bool collides(const Corners& corners, core::PartId part) {
    const core::Vec3 middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const core::Vec3 &a = corners[k], &b = corners[(k + 1) % 3];
      for (const core::Vec3& point : {a, core::Vec3(0.5 * (a + b)), core::Vec3(0.5 * (a + middle)), middle})
        if (contains(part, point, -tolerance_)) return true;
    }
    return false;
  }

  void leave_facets(core::PartId part, core::PartId other) {
    bodies_[part].leave_facets("its exact surface would extend into \"" +
                               assembly_.parts[other].geometry.name + "\"");
    changed_ = true;
  }

  const Assembly& assembly_;
  const std::vector<contact::InterfaceTriangle>& triangles_;
  PartBodies& bodies_;
  double tolerance_;
  bool changed_ = false;
  std::map<core::PartId, RegionContent> regions_;
  std::map<core::PartId, Samples> samples_;
  std::map<core::PartId, ExactBodies> alone_;  ///< of parts that are not convex
};

}  // namespace

PartBodies find_part_bodies(const Assembly& assembly,
                            const std::vector<contact::InterfaceTriangle>& triangles) {
  PartBodies bodies;
  const bool any = std::any_of(assembly.parts.begin(), assembly.parts.end(),
                               [](const AssemblyPart& part) { return !part.geometry.supports.empty(); });
  if (!any) return bodies;
  const auto of_parts = triangles_of_parts(assembly, triangles);
  for (const core::PartId part : assembly.parts.ids()) {
    const contact::PlacedPart& geometry = assembly.parts[part].geometry;
    PartBody body = BodyFinder(geometry, of_parts[part], assembly.contact_tolerance_mm).find();
    if (body.round && assembly.curved == scene_file::CurvedFaces::facets)
      body.leave_facets("run.curved is \"facets\"");
    bodies.push_back(std::move(body));
  }
  do match_contacts(assembly, triangles, bodies);
  while (ClearanceCheck(assembly, triangles, bodies).run());
  return bodies;
}

bool fit_exactly(const Assembly& assembly, const PartBodies& bodies, core::PartId a, core::PartId b) {
  if (bodies.empty()) return false;
  const contact::PlacedPart &first = assembly.parts[a].geometry, &second = assembly.parts[b].geometry;
  if (!first.supports.empty() && !bodies[a].round) return false;
  if (!second.supports.empty() && !bodies[b].round) return false;
  Eigen::AlignedBox3d box;  // around the second
  for (const core::Vec3& vertex : second.vertices) box.extend(vertex);
  for (std::size_t t = 0; t < first.support.size(); ++t) {
    if (first.support[t] == mesh::kNoSupport) continue;
    const auto& [i, j, k] = first.triangles[t];
    const Corners corners{first.vertices[i], first.vertices[j], first.vertices[k]};
    Eigen::AlignedBox3d own;
    for (const core::Vec3& corner : corners) own.extend(corner);
    if (!own.intersects(box)) continue;
    const mesh::SupportSurface& surface = first.supports[first.support[t]];
    for (const mesh::SupportSurface& other : second.supports)
      if (surface.kind() == other.kind() &&
          surface.agrees_with(other, corners, kOnSurface * assembly.contact_tolerance_mm))
        return false;
  }
  return true;
}

}  // namespace scintray::scene
