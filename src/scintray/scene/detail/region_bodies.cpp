#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "scintray/scene/detail/round_parts.hpp"

namespace scintray::scene {

namespace {

/// Distance from a plane, relative to the region's size, within which two planes are one.
constexpr double kSamePlane = 1e-10;

/// Maker of the exact bodies of one region.
class RegionBodies {
 public:
  RegionBodies(const PartBodies& bodies, core::PartId of, const RegionFrame& frame,
               const std::vector<RegionTriangle>& triangles)
      : bodies_(bodies), of_(of), frame_(frame), triangles_(triangles) {}

  ExactBodies make() {
    Eigen::AlignedBox3d bounds;
    for (const RegionTriangle& t : triangles_)
      for (const core::Vec3& corner : t.local) bounds.extend(corner);
    same_plane_ = kSamePlane * bounds.diagonal().norm();
    std::map<core::PartId, std::vector<std::uint32_t>> on;  // triangles of each body
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
      if (on_exact_body(bodies_, of_, triangles_[i].body))
        on[triangles_[i].body].push_back(i);
      else
        ++result_.meshed;
    }
    result_.quadric_of.assign(triangles_.size(), kNoSurface);
    result_.held = on.contains(of_);
    for (const core::PartId part : in_order(on)) add(part, on.at(part));
    result_.build_tree();
    return std::move(result_);
  }

 private:
  /// The body that holds the region, then the others, the largest first, so that a body that is nested in
  /// another and flush with it comes after it.
  std::vector<core::PartId> in_order(const std::map<core::PartId, std::vector<std::uint32_t>>& on) const {
    std::vector<std::pair<double, core::PartId>> sizes;
    for (const auto& [part, own] : on)
      sizes.emplace_back(part == of_ ? -HUGE_VAL : -farthest(part, local_centre(part)), part);
    std::sort(sizes.begin(), sizes.end());
    std::vector<core::PartId> order;
    for (const auto& entry : sizes) order.push_back(entry.second);
    return order;
  }

  /// The plane in the region's frame; a plane of a body before it that is the same to rounding has its bits.
  BodyPlane local(const WorldPlane& plane) const {
    const core::Vec3 normal = frame_.direction(plane.normal);
    const double offset = plane.offset - plane.normal.dot(frame_.centre);
    for (const BodyPlane& known : result_.planes)
      if ((known.normal - normal).norm() <= 1e-9 && std::abs(known.offset - offset) <= same_plane_)
        return {known.normal, known.offset, {}};
    return {normal, offset, {}};
  }

  void add(core::PartId part, const std::vector<std::uint32_t>& own) {
    const PartBody& of_part = bodies_[part];
    ExactBody body;
    body.first = own.front();
    // Around all corners of the part, of which the region may have but a few, and what bulges beyond them.
    Eigen::AlignedBox3d box;
    for (const std::uint32_t i : own)
      for (const core::Vec3& corner : triangles_[i].local) box.extend(corner);
    for (const core::Vec3& vertex : of_part.corners) box.extend(frame_.point(vertex));
    const core::Vec3 bulge = core::Vec3::Constant(2.0 * of_part.deviation_mm + 1e-9 * box.diagonal().norm());
    body.low = box.min() - bulge;
    body.high = box.max() + bulge;
    body.planes_begin = static_cast<std::uint32_t>(result_.planes.size());
    body.quadrics_begin = static_cast<std::uint32_t>(result_.quadrics.size());
    std::vector<BodyPlane> planes;
    for (const WorldPlane& plane : of_part.planes) planes.push_back(local(plane));
    result_.planes.insert(result_.planes.end(), planes.begin(), planes.end());
    for (const mesh::SupportSurface& quadric : of_part.quadrics)
      result_.quadrics.push_back({frame_.surface(quadric), {}, part == of_});
    for (const PartFace& face : of_part.faces)
      if (face.wall) result_.quadrics[body.quadrics_begin + face.quadric].around_region = part != of_;
    body.planes_end = static_cast<std::uint32_t>(result_.planes.size());
    body.quadrics_end = static_cast<std::uint32_t>(result_.quadrics.size());
    if (!of_part.faces.empty()) add_trimmed_faces(of_part, frame_, body, result_);
    assign(body, own);
    result_.bodies.push_back(body);
  }

  double farthest(core::PartId part, const core::Vec3& centre) const {
    double radius = 0.0;
    for (const core::Vec3& vertex : bodies_[part].corners)
      radius = std::max(radius, (frame_.point(vertex) - centre).norm());
    return radius;
  }

  /// Distributes triangles of a body over its surfaces.
  void assign(const ExactBody& body, const std::vector<std::uint32_t>& own) {
    std::map<SurfaceTriangles*, std::vector<std::uint32_t>> on;
    for (const std::uint32_t i : own) {
      const RegionTriangle& t = triangles_[i];
      if (t.support != mesh::kNoSupport) {
        result_.quadric_of[i] = body.quadrics_begin + t.support;
        on[&result_.quadrics[result_.quadric_of[i]].on].push_back(i);
      } else {
        on[&plane_of(body, t)->on].push_back(i);
      }
    }
    for (auto& [surface, list] : on) describe(*surface, list);
  }

  BodyPlane* plane_of(const ExactBody& body, const RegionTriangle& t) {
    const core::Vec3 normal = doubled_area(t.local).normalized() * (t.body == of_ ? 1.0 : -1.0);
    BodyPlane* best = nullptr;
    double least = HUGE_VAL;
    for (std::uint32_t i = body.planes_begin; i < body.planes_end; ++i) {
      BodyPlane& plane = result_.planes[i];
      double off = (plane.normal - normal).norm() * doubled_area(t.local).norm();
      for (const core::Vec3& corner : t.local) off += std::abs(plane.normal.dot(corner) - plane.offset);
      if (off >= least) continue;
      least = off;
      best = &plane;
    }
    return best;
  }

  void describe(SurfaceTriangles& surface, const std::vector<std::uint32_t>& list) {
    surface.first = list.front();
    const bool one_label = std::all_of(list.begin(), list.end(), [&](std::uint32_t i) {
      return triangles_[i].label == triangles_[list.front()].label;
    });
    if (one_label) return;
    std::map<core::PartId, std::vector<std::uint32_t>> under;  // round parts on the surface
    for (const std::uint32_t i : list)
      if (const RegionTriangle& t = triangles_[i];
          t.body == of_ && t.other.has_value() && t.other != of_ && bodies_[t.other].round)
        under[t.other].push_back(i);
    std::map<core::PartId, std::uint32_t> ends;  // those that lead to one region by one interface
    for (const auto& [part, own] : under) {
      const std::uint32_t first = own.front();
      if (std::all_of(own.begin(), own.end(),
                      [&](std::uint32_t i) { return triangles_[i].label == triangles_[first].label; }))
        ends.emplace(part, first);
    }
    surface.outlines_begin = static_cast<std::uint32_t>(result_.outlines.size());
    add_outlines(ends);
    surface.outlines_end = static_cast<std::uint32_t>(result_.outlines.size());
    std::set<core::PartId> outlined;
    for (std::uint32_t i = surface.outlines_begin; i < surface.outlines_end; ++i)
      outlined.insert(triangles_[result_.outlines[i].triangle].other);
    std::vector<std::uint32_t> rest;
    for (const std::uint32_t i : list)
      if (triangles_[i].body != of_ || !outlined.contains(triangles_[i].other)) rest.push_back(i);
    if (rest.empty()) rest = list;
    surface.begin = static_cast<std::uint32_t>(result_.triangles.size());
    result_.triangles.insert(result_.triangles.end(), rest.begin(), rest.end());
    surface.end = static_cast<std::uint32_t>(result_.triangles.size());
  }

  /// Smaller ends first, since they may be nested in larger ones.
  void add_outlines(const std::map<core::PartId, std::uint32_t>& ends) {
    std::vector<std::pair<double, core::PartId>> sizes;
    for (const auto& [part, triangle] : ends) sizes.emplace_back(farthest(part, local_centre(part)), part);
    std::sort(sizes.begin(), sizes.end());
    for (const auto& [size, part] : sizes) {
      const RegionTriangle& under = triangles_[ends.at(part)];
      EndOutline outline;
      outline.triangle = ends.at(part);
      if (under.support != mesh::kNoSupport) {
        const std::optional<PartFace> face = round_face(part, under);
        if (!face) continue;
        outline.face = add_trimmed_face(*face, frame_, {}, result_);  // for its outline alone
        result_.outlines.push_back(outline);
        continue;
      }
      if (!bodies_[part].faces.empty()) {
        outline.face = end_face(part, under);
        result_.outlines.push_back(outline);
        continue;
      }
      outline.quadrics_begin = static_cast<std::uint32_t>(result_.outline_of.size());
      for (const mesh::SupportSurface& quadric : bodies_[part].quadrics)
        result_.outline_of.push_back(frame_.surface(quadric));
      outline.quadrics_end = static_cast<std::uint32_t>(result_.outline_of.size());
      result_.outlines.push_back(outline);
    }
  }

  /// The face of a part on the round surface that it has in common with this region's part, at a triangle
  /// under it. Nothing where that is not found.
  std::optional<PartFace> round_face(core::PartId part, const RegionTriangle& under) const {
    const PartBody &own = bodies_[of_], &other = bodies_[part];
    Corners corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = frame_.centre + frame_.rotation * under.local[k];
    const auto common =
        std::find_if(other.quadrics.begin(), other.quadrics.end(), [&](const mesh::SupportSurface& surface) {
          return surface.kind() == own.quadrics[under.support].kind() &&
                 own.quadrics[under.support].agrees_with(surface, corners, other.off_surface_mm);
        });
    if (common == other.quadrics.end()) return std::nullopt;
    const auto number = static_cast<std::uint32_t>(common - other.quadrics.begin());
    for (const PartFace& face : other.faces)
      if (face.quadric == number) return face;
    if (!other.convex) return std::nullopt;
    PartFace face;  // where the part is inside of all its other surfaces
    face.quadric = number;
    face.corners = other.corners;
    face.bulge_mm = 2.0 * other.deviation_mm;
    for (const WorldPlane& plane : other.planes) face.trims.push_back({std::nullopt, plane, false});
    for (const mesh::SupportSurface& surface : other.quadrics)
      if (&surface != &*common) face.trims.push_back({surface, {}, false});
    return face;
  }

  /// The flat face of a part that is not convex, at a triangle under it, in this region's frame.
  std::uint32_t end_face(core::PartId part, const RegionTriangle& under) {
    const PartBody& of_part = bodies_[part];
    const core::Vec3 normal = frame_.rotation * doubled_area(under.local).normalized() * -1.0;
    const core::Vec3 point = frame_.centre + frame_.rotation * under.local[0];
    const auto off = [&](const PartFace& face) {
      if (face.plane == kNoSurface) return HUGE_VAL;
      const WorldPlane& plane = of_part.planes[face.plane];
      return (plane.normal - normal).norm() + std::abs(plane.normal.dot(point) - plane.offset);
    };
    const PartFace& face =
        *std::min_element(of_part.faces.begin(), of_part.faces.end(),
                          [&](const PartFace& a, const PartFace& b) { return off(a) < off(b); });
    return add_trimmed_face(face, frame_, {}, result_);  // for its outline alone
  }

  core::Vec3 local_centre(core::PartId part) const {
    Eigen::AlignedBox3d bounds;
    for (const core::Vec3& vertex : bodies_[part].corners) bounds.extend(frame_.point(vertex));
    return bounds.center();
  }

  const PartBodies& bodies_;
  core::PartId of_;
  const RegionFrame& frame_;
  const std::vector<RegionTriangle>& triangles_;
  double same_plane_ = 0.0;
  ExactBodies result_;
};

}  // namespace

bool on_exact_body(const PartBodies& bodies, core::PartId of, core::PartId body) {
  return body.has_value() && (body == of ? bodies[body].is_exact() : bodies[body].round);
}

bool needs_exact_bodies(const PartBodies& bodies, core::PartId of,
                        const std::vector<RegionTriangle>& triangles) {
  if (bodies.empty()) return false;
  const bool any_round = std::any_of(triangles.begin(), triangles.end(),
                                     [&](const RegionTriangle& t) { return bodies[t.body].round; });
  if (any_round) return true;
  if (!of.has_value() || !bodies[of].convex) return false;
  // A plane that an end of a round part covers in part.
  const auto beside = [&](const RegionTriangle& t, const RegionTriangle& end) {
    const core::Vec3 normal = doubled_area(end.local).normalized();
    return t.body == of && t.label != end.label && doubled_area(t.local).dot(normal) > 0.0 &&
           std::all_of(t.local.begin(), t.local.end(), [&](const core::Vec3& corner) {
             return std::abs(normal.dot(corner - end.local[0])) <=
                    kSamePlane * (corner - end.local[0]).norm();
           });
  };
  std::set<std::uint32_t> seen;  // labels
  return std::any_of(triangles.begin(), triangles.end(), [&](const RegionTriangle& end) {
    return end.body == of && end.other.has_value() && bodies[end.other].round &&
           seen.insert(end.label).second &&
           std::any_of(triangles.begin(), triangles.end(),
                       [&](const RegionTriangle& t) { return beside(t, end); });
  });
}

ExactBodies exact_bodies_of(const PartBodies& bodies, core::PartId of, const RegionFrame& frame,
                            const std::vector<RegionTriangle>& triangles) {
  return RegionBodies(bodies, of, frame, triangles).make();
}

}  // namespace scintray::scene
