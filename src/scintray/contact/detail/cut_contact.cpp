#include "scintray/contact/detail/stitch.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "scintray/contact/detail/boolean_difference.hpp"
#include "scintray/contact/detail/facing.hpp"
#include "scintray/mesh/shapes/polygon.hpp"
#include "scintray/mesh/triangle_distance.hpp"

namespace scintray::contact {

namespace {

/// The directed sides of triangles.
using Sides = std::set<std::pair<std::uint32_t, std::uint32_t>>;
Sides sides_of(const std::vector<std::array<std::uint32_t, 3>>& triangles) {
  Sides sides;
  for (const auto& triangle : triangles)
    for (std::size_t k = 0; k < 3; ++k) sides.emplace(triangle[k], triangle[(k + 1) % 3]);
  return sides;
}

/// Outlines of triangles; empty where two of them share a vertex.
std::optional<std::vector<Loop>> outlines_of(const std::vector<std::array<std::uint32_t, 3>>& triangles) {
  const Sides sides = sides_of(triangles);
  std::map<std::uint32_t, std::uint32_t> next;
  for (const auto& [from, to] : sides)
    if (!sides.contains({to, from}) && !next.emplace(from, to).second) return std::nullopt;
  std::vector<Loop> loops;
  while (!next.empty()) {
    const std::uint32_t start = next.begin()->first;
    Loop loop;
    for (std::uint32_t at = start; loop.empty() || at != start;) {
      const auto side = next.find(at);
      if (side == next.end()) return std::nullopt;
      loop.push_back(at);
      at = side->second;
      next.erase(side);
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

}  // namespace

ContactSide contact_side(const PlacedMesh& part, const PlacedMesh& other, const ContactRule& rule,
                         bool is_reference) {
  const auto& [own_wall, other_wall] = is_reference
                                           ? std::tie(rule.wall_of_reference, rule.wall_of_conforming)
                                           : std::tie(rule.wall_of_conforming, rule.wall_of_reference);
  ContactSide side{part, Body(geometry_of(part), Eigen::Matrix3d::Identity()), own_wall, {}, {}};
  const Body other_body(geometry_of(other), Eigen::Matrix3d::Identity());
  for (const Facing f : facing(side.body, other_body, rule.reach, {own_wall, other_wall}))
    side.facing.push_back(f == Facing::covered || f == Facing::partly);
  side.zone = pushed(part.mesh, side.body, side.facing, kContactPush * rule.reach.tolerance);
  return side;
}

void split_edge(CutPart& part, std::uint32_t a, std::uint32_t b, std::uint32_t v) {
  const std::size_t count = part.mesh.triangles.size();
  for (std::size_t t = 0; t < count; ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t p = part.mesh.triangles[t][k], q = part.mesh.triangles[t][(k + 1) % 3],
                          r = part.mesh.triangles[t][(k + 2) % 3];
      if (!(p == a && q == b) && !(p == b && q == a)) continue;
      part.mesh.triangles[t] = {p, v, r};
      part.mesh.triangles.push_back({v, q, r});
      part.mesh.group.push_back(part.mesh.group[t]);
      part.origin.push_back(part.origin[t]);
      part.contact.push_back(part.contact[t]);
      break;
    }
}

std::uint32_t add_vertex(mesh::TriMesh& mesh, const core::Vec3& position) {
  mesh.vertices.push_back(position);
  return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

namespace {

/// The pieces of a part's facing triangles, and its other triangles uncut: cuts that continue through faces
/// outside the contact would leave slivers beside it.
CutPart only_facing_cut(const ContactSide& side, const mesh::BooleanResult& cut) {
  CutPart result;
  result.mesh.vertices = cut.mesh.vertices;
  result.mesh.groups = cut.mesh.groups;
  result.mesh.group_tags = cut.mesh.group_tags;
  const auto add = [&](const std::array<std::uint32_t, 3>& triangle, std::uint32_t own) {
    result.mesh.triangles.push_back(triangle);
    result.mesh.group.push_back(side.part.mesh.group.empty() ? 0 : side.part.mesh.group[own]);
    result.origin.push_back(own);
  };
  for (std::size_t t = 0; t < cut.origin.size(); ++t)
    if (side.facing[cut.origin[t].triangle]) add(cut.mesh.triangles[t], cut.origin[t].triangle);
  const Sides pieces = sides_of(result.mesh.triangles);

  // Vertices that survive a cut keep their positions exactly.
  std::map<std::array<double, 3>, std::uint32_t> index;
  const auto key = [](const core::Vec3& v) { return std::array<double, 3>{v.x(), v.y(), v.z()}; };
  for (std::uint32_t v = 0; v < cut.mesh.vertices.size(); ++v) index.emplace(key(cut.mesh.vertices[v]), v);
  std::set<std::uint32_t> own_vertices;
  for (std::uint32_t own = 0; own < side.facing.size(); ++own) {
    std::array<std::uint32_t, 3> triangle = side.part.mesh.triangles[own];
    for (std::uint32_t& v : triangle) {
      const core::Vec3& place = side.part.mesh.vertices[v];
      const auto [known, is_new] = index.emplace(key(place), 0U);
      if (is_new) known->second = add_vertex(result.mesh, place);
      own_vertices.insert(v = known->second);
    }
    if (!side.facing[own]) add(triangle, own);
  }
  result.contact.assign(result.origin.size(), 0);

  // Where a cut ends on an edge between both kinds, the whole triangle beside it gets that corner, too.
  std::map<std::uint32_t, std::uint32_t> next;  // from corners that the cut made
  for (const auto& [from, to] : pieces)
    if (!pieces.contains({to, from}) && !own_vertices.contains(from)) next[from] = to;
  for (const auto& [from, to] : pieces) {
    if (pieces.contains({to, from}) || !own_vertices.contains(from)) continue;
    std::vector<std::uint32_t> corners;
    std::uint32_t end = to;
    for (auto at = next.find(end); at != next.end() && corners.size() <= next.size(); at = next.find(end)) {
      corners.push_back(end);
      end = at->second;
    }
    std::uint32_t start = from;
    for (const std::uint32_t corner : corners) {
      split_edge(result, start, end, corner);
      start = corner;
    }
  }
  return result;
}

/// The polygon in triangles, without corners within one own triangle that lie straight between their
/// neighbours; no triangles when it crosses itself.
std::vector<std::array<std::uint32_t, 3>> without_needless_corners(
    const mesh::TriMesh& mesh, const Loop& polygon, const std::vector<std::set<std::uint32_t>>& owners) {
  constexpr double kStraight_mm = 1e-7;
  Loop corners;
  std::vector<core::Vec3> places;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const core::Vec3 &before = mesh.vertices[polygon[(i + polygon.size() - 1) % polygon.size()]],
                     &here = mesh.vertices[polygon[i]],
                     &after = mesh.vertices[polygon[(i + 1) % polygon.size()]];
    if (owners[polygon[i]].size() == 1 && mesh::distance_to_segment(here, before, after) < kStraight_mm)
      continue;
    corners.push_back(polygon[i]);
    places.push_back(here);
  }
  bool simple = true;
  std::vector<std::array<std::uint32_t, 3>> triangles = mesh::triangulate_polygon(places, simple);
  for (auto& triangle : triangles)
    for (std::uint32_t& v : triangle) v = corners[v];
  if (!simple) triangles.clear();
  return triangles;
}

/// Merges the pieces of each cut triangle that lie on the same side of the contact's outline: what is left is
/// the outline, without the corners that the triangles of the other part made along it.
void unite_pieces(CutPart& part) {
  const mesh::TriMesh& mesh = part.mesh;
  std::vector<std::set<std::uint32_t>> owners(mesh.vertices.size());  // own triangles around each vertex
  std::map<std::pair<std::uint32_t, char>, std::vector<std::size_t>> pieces;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    pieces[{part.origin[t], part.contact[t]}].push_back(t);
    for (const std::uint32_t v : mesh.triangles[t]) owners[v].insert(part.origin[t]);
  }
  CutPart united;
  united.mesh.vertices = mesh.vertices;
  united.mesh.groups = mesh.groups;
  united.mesh.group_tags = mesh.group_tags;
  for (const auto& [of, triangles] : pieces) {
    std::vector<std::array<std::uint32_t, 3>> as_they_are, made;
    for (const std::size_t t : triangles) as_they_are.push_back(mesh.triangles[t]);
    const auto outlines = outlines_of(as_they_are);
    if (triangles.size() > 1 && outlines && outlines->size() == 1)
      made = without_needless_corners(mesh, outlines->front(), owners);
    for (const auto& triangle : made.empty() ? as_they_are : made) {
      united.mesh.triangles.push_back(triangle);
      united.mesh.group.push_back(mesh.group[triangles.front()]);
      united.origin.push_back(of.first);
      united.contact.push_back(of.second);
    }
  }
  part = std::move(united);
}

}  // namespace

std::optional<CutPart> cut_at_contact(const ContactSide& side, const ContactSide& other,
                                      const ContactReach& reach, const Eigen::Matrix3d& axes) {
  const auto cut = imprint_on_grid(side.part.mesh, other.zone, axes, reach.flat);
  if (!cut) return std::nullopt;
  CutPart result = only_facing_cut(side, *cut);
  const Body zone(PlacedPart{"", other.zone.vertices, other.zone.triangles,
                             std::vector<core::FaceId>(other.zone.triangles.size())},
                  Eigen::Matrix3d::Identity());
  for (std::size_t t = 0; t < result.origin.size(); ++t) {
    const std::uint32_t own = result.origin[t];
    const core::Vec3 centre = mesh::centre_of(result.mesh, t);
    result.contact[t] =
        side.facing[own] && zone.side_of(centre, 0.0) == Side::inside &&
        nearest(other.body, centre, side.body.normal[own], true, reach.tolerance, &other.wall).found();
  }
  unite_pieces(result);
  std::vector<std::array<std::uint32_t, 3>> contact_triangles;
  for (std::size_t t = 0; t < result.contact.size(); ++t)
    if (result.contact[t]) contact_triangles.push_back(result.mesh.triangles[t]);
  const auto outlines = outlines_of(contact_triangles);
  if (!outlines) return std::nullopt;
  result.outlines = *outlines;
  return result;
}

}  // namespace scintray::contact
