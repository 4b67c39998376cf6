#include "scintray/scene/stitch_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "scintray/mesh/diagnose_in_place.hpp"
#include "scintray/mesh/polygon.hpp"
#include "scintray/mesh/weld.hpp"
#include "scintray/scene/carve.hpp"
#include "scintray/scene/contact_facing.hpp"

namespace scintray {

namespace {

using contact::Body;
using contact::Facing;
using contact::Nearest;

constexpr double kPush = 2.0;   // in tolerances: past the deepest sliver, with room
constexpr double kSame = 0.05;  // in tolerances: outline corners this near to each other are one

using Loop = std::vector<std::uint32_t>;  // vertices, the first one after the last

/// A part cut where its contact with another ends.
struct CutPart {
  TriMesh mesh;
  std::vector<std::uint32_t> origin;  ///< per triangle, the part's own triangle that it is a piece of
  std::vector<char> contact;          ///< per triangle
  std::vector<Loop> outlines;         ///< of the contact, which lies to their left seen from outside
};

/// The directed sides of triangles.
using Sides = std::set<std::pair<std::uint32_t, std::uint32_t>>;
Sides sides_of(const std::vector<std::array<std::uint32_t, 3>>& triangles) {
  Sides sides;
  for (const auto& triangle : triangles)
    for (std::size_t k = 0; k < 3; ++k) sides.emplace(triangle[k], triangle[(k + 1) % 3]);
  return sides;
}

/// Outlines of the marked triangles; nothing where two of them meet in a vertex.
std::optional<std::vector<Loop>> outlines_of(const TriMesh& mesh, const std::vector<char>& marked) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (marked[t]) triangles.push_back(mesh.triangles[t]);
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

/// A part with what the cuts need.
struct Side {
  const PlacedMesh& part;
  Body body;
  std::vector<char> facing;  ///< per triangle: in part or wholly within the tolerance of the other part
  TriMesh zone;              ///< pushed outwards there
};

Side side_of(const PlacedMesh& part, const PlacedMesh& other, double tolerance, double flat_mm) {
  Side side{part, Body(geometry_of(part), Eigen::Matrix3d::Identity()), {}, {}};
  const Body other_body(geometry_of(other), Eigen::Matrix3d::Identity());
  for (const Facing f : contact::facing(side.body, other_body, tolerance, flat_mm))
    side.facing.push_back(f == Facing::covered || f == Facing::partly);
  side.zone = contact::pushed(part.mesh, side.body, side.facing, kPush * tolerance);
  return side;
}

/// Puts vertex `v` on the edge between two vertices: each triangle there becomes two. `origin` and `contact`
/// follow.
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

std::uint32_t add_vertex(TriMesh& mesh, const Vec3& position) {
  mesh.vertices.push_back(position);
  return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const double share = std::clamp((p - a).dot(b - a) / std::max((b - a).squaredNorm(), 1e-300), 0.0, 1.0);
  return (p - (a + share * (b - a))).norm();
}

/// The pieces of a part's facing triangles, and its other triangles whole: cuts that run on through faces
/// that have no part in the contact would leave slivers beside it.
CutPart only_facing_cut(const Side& side, const BooleanResult& cut) {
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

  // Vertices that survive a cut keep their places exactly.
  std::map<std::array<double, 3>, std::uint32_t> index;
  const auto key = [](const Vec3& v) { return std::array<double, 3>{v.x(), v.y(), v.z()}; };
  for (std::uint32_t v = 0; v < cut.mesh.vertices.size(); ++v) index.emplace(key(cut.mesh.vertices[v]), v);
  std::set<std::uint32_t> own_vertices;
  for (std::uint32_t own = 0; own < side.facing.size(); ++own) {
    std::array<std::uint32_t, 3> triangle = side.part.mesh.triangles[own];
    for (std::uint32_t& v : triangle) {
      const Vec3& place = side.part.mesh.vertices[v];
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
    const TriMesh& mesh, const Loop& polygon, const std::vector<std::set<std::uint32_t>>& owners) {
  constexpr double kStraight_mm = 1e-7;
  Loop corners;
  std::vector<Vec3> places;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &before = mesh.vertices[polygon[(i + polygon.size() - 1) % polygon.size()]],
               &here = mesh.vertices[polygon[i]], &after = mesh.vertices[polygon[(i + 1) % polygon.size()]];
    if (owners[polygon[i]].size() == 1 && distance_to_segment(here, before, after) < kStraight_mm) continue;
    corners.push_back(polygon[i]);
    places.push_back(here);
  }
  bool simple = true;
  std::vector<std::array<std::uint32_t, 3>> triangles = triangulate_polygon(places, simple);
  for (auto& triangle : triangles)
    for (std::uint32_t& v : triangle) v = corners[v];
  if (!simple) triangles.clear();
  return triangles;
}

/// Puts the pieces of each cut triangle together again as far as they lie on one side of the contact's
/// outline: what is left is the outline, without the corners that the triangles of the other part made along
/// it.
void unite_pieces(CutPart& part) {
  const TriMesh& mesh = part.mesh;
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
    std::vector<char> marked(mesh.triangles.size(), 0);
    for (const std::size_t t : triangles) {
      as_they_are.push_back(mesh.triangles[t]);
      marked[t] = 1;
    }
    const auto outlines = outlines_of(mesh, marked);
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

/// Cuts a part where its contact with the other ends. Nothing when CGAL refuses, or the contact has no
/// plain outline.
std::optional<CutPart> cut_at_contact(const Side& side, const Side& other, double tolerance, double flat_mm,
                                      const Eigen::Matrix3d& axes) {
  const auto cut = imprint_on_grid(side.part.mesh, other.zone, axes, flat_mm);
  if (!cut) return std::nullopt;
  CutPart result = only_facing_cut(side, *cut);
  const Body zone(PlacedPart{"", other.zone.vertices, other.zone.triangles,
                             std::vector<std::uint32_t>(other.zone.triangles.size(), 0)},
                  Eigen::Matrix3d::Identity());
  for (std::size_t t = 0; t < result.origin.size(); ++t) {
    const std::uint32_t own = result.origin[t];
    const Vec3 centre = centre_of(result.mesh, t);
    result.contact[t] = side.facing[own] && zone.side_of(centre, 0.0) == contact::Side::inside &&
                        contact::nearest(other.body, centre, side.body.normal[own], true, tolerance).found();
  }
  unite_pieces(result);
  const auto outlines = outlines_of(result.mesh, result.contact);
  if (!outlines) return std::nullopt;
  result.outlines = *outlines;
  return result;
}

/// A closed line, with places on it by the length of the way along it.
class Outline {
 public:
  Outline(const TriMesh& mesh, const Loop& loop) {
    for (const std::uint32_t v : loop) corners_.push_back(mesh.vertices[v]);
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      starts_.push_back(length_);
      length_ += (corner(i + 1) - corner(i)).norm();
    }
  }

  struct Place {
    double along = 0.0, distance = HUGE_VAL;
  };
  Place nearest(const Vec3& p) const {
    Place best;
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const Vec3 edge = corner(i + 1) - corner(i);
      const double share =
          std::clamp((p - corner(i)).dot(edge) / std::max(edge.squaredNorm(), 1e-300), 0.0, 1.0);
      const double d = (p - (corner(i) + share * edge)).norm();
      if (d < best.distance) best = {starts_[i] + share * edge.norm(), d};
    }
    return best;
  }
  double length() const { return length_; }
  double start(std::size_t i) const { return starts_[i]; }
  std::size_t size() const { return corners_.size(); }
  const Vec3& corner(std::size_t i) const { return corners_[i % corners_.size()]; }
  Vec3 at(std::size_t edge, double along) const {
    const Vec3 whole = corner(edge + 1) - corner(edge);
    return corner(edge) + whole * ((along - starts_[edge]) / whole.norm());
  }

 private:
  std::vector<Vec3> corners_;
  std::vector<double> starts_;
  double length_ = 0.0;
};

/// A place of the common outline, in order along the keeper's.
struct Knot {
  double along = 0.0;
  Vec3 position;
  std::uint32_t of_keeper = ~0U, of_taker = ~0U;  ///< vertices
};

/// Makes one outline of two.
class OutlineStitcher {
 public:
  OutlineStitcher(CutPart& keeper, CutPart& taker, const Loop& keeper_loop, const Loop& taker_loop,
                  double tolerance)
      : keeper_(keeper),
        taker_(taker),
        keeper_loop_(keeper_loop.rbegin(), keeper_loop.rend()),  // the other way round, as seen from here
        taker_loop_(taker_loop),
        outline_(keeper.mesh, keeper_loop_),
        reach_(kPush * tolerance),
        same_(kSame * tolerance) {}

  /// The common outline; nothing where the two run too far apart or in another order. Moves the taker's
  /// corners and cuts edges of both; `merged` says which of the taker's vertices become others.
  std::optional<std::vector<Knot>> stitch(std::map<std::uint32_t, std::uint32_t>& merged, double& moved) {
    if (!place_corners(moved)) return std::nullopt;
    make_knots();
    if (!move_taker(merged, moved)) return std::nullopt;
    cut_keeper();
    return knots_;
  }

 private:
  /// Finds the places of the taker's corners along the keeper's outline, each after the one before.
  bool place_corners(double& moved) {
    for (const std::uint32_t v : taker_loop_) {
      const Outline::Place place = outline_.nearest(taker_.mesh.vertices[v]);
      if (place.distance > reach_) return false;
      moved = std::max(moved, place.distance);
      places_.push_back(snapped(place.along));
    }
    double turn = 0.0;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      double& next = places_[(i + 1) % places_.size()];
      double step = next - places_[i];
      if (step < 0.0) step += outline_.length();
      if (outline_.length() - step <= same_) {  // a hair backwards
        next = places_[i];
        step = 0.0;
      }
      turn += step;
    }
    return std::abs(turn - outline_.length()) <= 1e-6 * outline_.length();
  }

  /// A corner of the outline when there is one that near.
  double snapped(double along) const {
    for (std::size_t i = 0; i < outline_.size(); ++i)
      if (std::abs(along - outline_.start(i)) <= same_) return outline_.start(i);
    return outline_.length() - along <= same_ ? 0.0 : along;
  }

  void make_knots() {
    std::vector<double> between = places_;
    std::sort(between.begin(), between.end());
    for (std::size_t edge = 0; edge < outline_.size(); ++edge) {
      const double start = outline_.start(edge);
      const double end = edge + 1 < outline_.size() ? outline_.start(edge + 1) : outline_.length();
      knots_.push_back({start, outline_.corner(edge), keeper_loop_[edge], ~0U});
      double last = start;
      for (const double along : between)
        if (along > last + same_ && along < end - same_ / 2) {
          knots_.push_back({along, outline_.at(edge, along), ~0U, ~0U});
          last = along;
        }
    }
  }

  std::size_t knot_at(double along) const {
    std::size_t best = 0;
    double least = HUGE_VAL;
    for (std::size_t i = 0; i < knots_.size(); ++i)
      if (const double off = std::abs(knots_[i].along - along); off < least) {
        least = off;
        best = i;
      }
    return best;
  }

  bool move_taker(std::map<std::uint32_t, std::uint32_t>& merged, double& moved) {
    std::vector<std::size_t> knot_of;
    for (const double along : places_) knot_of.push_back(knot_at(along));
    const std::vector<Vec3> before = taker_.mesh.vertices;
    for (std::size_t i = 0; i < taker_loop_.size(); ++i) {
      Knot& knot = knots_[knot_of[i]];
      if (knot.of_taker == ~0U)
        knot.of_taker = taker_loop_[i];
      else if (knot.of_taker != taker_loop_[i])
        merged[taker_loop_[i]] = knot.of_taker;
      taker_.mesh.vertices[taker_loop_[i]] = knot.position;
    }
    for (std::size_t i = 0; i < taker_loop_.size(); ++i) {
      const std::size_t end = knot_of[(i + 1) % knot_of.size()];
      const std::uint32_t last = taker_loop_[(i + 1) % taker_loop_.size()];
      std::uint32_t from = taker_loop_[i];
      if (end == knot_of[i]) continue;
      for (std::size_t k = (knot_of[i] + 1) % knots_.size(); k != end; k = (k + 1) % knots_.size()) {
        const double off = distance_to_segment(knots_[k].position, before[taker_loop_[i]], before[last]);
        if (off > reach_ || knots_[k].of_taker != ~0U) return false;
        moved = std::max(moved, off);
        knots_[k].of_taker = add_vertex(taker_.mesh, knots_[k].position);
        split_edge(taker_, from, last, knots_[k].of_taker);
        from = knots_[k].of_taker;
      }
    }
    return true;
  }

  void cut_keeper() {
    for (std::size_t k = 0; k < knots_.size(); ++k) {
      if (knots_[k].of_keeper != ~0U) continue;
      std::size_t end = k;
      while (knots_[end % knots_.size()].of_keeper == ~0U) ++end;
      knots_[k].of_keeper = add_vertex(keeper_.mesh, knots_[k].position);
      split_edge(keeper_, knots_[(k + knots_.size() - 1) % knots_.size()].of_keeper,
                 knots_[end % knots_.size()].of_keeper, knots_[k].of_keeper);
    }
  }

  CutPart &keeper_, &taker_;
  Loop keeper_loop_, taker_loop_;
  Outline outline_;
  double reach_, same_;
  std::vector<double> places_;  ///< of the taker's corners, along the outline
  std::vector<Knot> knots_;
};

/// Which outline of the keeper each of the taker's runs along; nothing when they are no pairs.
std::optional<std::vector<std::size_t>> pairs_of(const CutPart& keeper, const CutPart& taker) {
  if (keeper.outlines.size() != taker.outlines.size() || keeper.outlines.empty()) return std::nullopt;
  std::vector<std::size_t> pairs;
  for (const Loop& loop : taker.outlines) {
    std::size_t best = 0;
    double least = HUGE_VAL;
    for (std::size_t k = 0; k < keeper.outlines.size(); ++k) {
      const Outline outline(keeper.mesh, keeper.outlines[k]);
      double farthest = 0.0;
      for (const std::uint32_t v : loop)
        farthest = std::max(farthest, outline.nearest(taker.mesh.vertices[v]).distance);
      if (farthest < least) {
        least = farthest;
        best = k;
      }
    }
    pairs.push_back(best);
  }
  if (std::set<std::size_t>(pairs.begin(), pairs.end()).size() != pairs.size()) return std::nullopt;
  return pairs;
}

/// Triangles of the taker outside the contact, with merged vertices; those that collapse go.
CutPart without_contact(const CutPart& taker, const std::map<std::uint32_t, std::uint32_t>& merged) {
  CutPart rest;
  rest.mesh.vertices = taker.mesh.vertices;
  rest.mesh.groups = taker.mesh.groups;
  rest.mesh.group_tags = taker.mesh.group_tags;
  for (std::size_t t = 0; t < taker.mesh.triangles.size(); ++t) {
    if (taker.contact[t]) continue;
    auto triangle = taker.mesh.triangles[t];
    for (std::uint32_t& v : triangle)
      if (const auto other = merged.find(v); other != merged.end()) v = other->second;
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) continue;
    rest.mesh.triangles.push_back(triangle);
    rest.mesh.group.push_back(taker.mesh.group[t]);
    rest.origin.push_back(taker.origin[t]);
  }
  return rest;
}

/// Adds the keeper's contact triangles, turned round, to what is left of the taker. False when one strays
/// from the taker's own surface by more than `reach`.
bool add_contact(const CutPart& keeper, const Side& taker, const std::vector<Knot>& knots, double reach,
                 CutPart& rest, double& moved) {
  std::map<std::uint32_t, std::uint32_t> vertex;  // of the keeper, and the taker's
  for (const Knot& knot : knots) vertex[knot.of_keeper] = knot.of_taker;
  for (std::size_t t = 0; t < keeper.mesh.triangles.size(); ++t) {
    if (!keeper.contact[t]) continue;
    const auto& [a, b, c] = keeper.mesh.triangles[t];
    const Vec3 normal = -keeper.mesh.area_vector(t).normalized();
    const auto beside = [&](const Vec3& point) {
      return contact::nearest(taker.body, point, normal, false, reach);
    };
    const Nearest own = beside(centre_of(keeper.mesh, t));
    for (const Vec3& point :
         contact::samples_of(keeper.mesh.vertices[a], keeper.mesh.vertices[b], keeper.mesh.vertices[c])) {
      const Nearest here = beside(point);
      if (!here.found()) return false;
      moved = std::max(moved, here.distance);
    }
    std::array<std::uint32_t, 3> turned{a, c, b};
    for (std::uint32_t& v : turned) {
      const auto [known, is_new] = vertex.try_emplace(v, 0U);
      if (is_new) known->second = add_vertex(rest.mesh, keeper.mesh.vertices[v]);
      v = known->second;
    }
    rest.mesh.triangles.push_back(turned);
    rest.mesh.group.push_back(taker.part.mesh.group.empty() ? 0 : taker.part.mesh.group[own.triangle]);
    rest.origin.push_back(own.triangle);
  }
  return true;
}

/// Takes out triangles whose corners came to lie on one edge of the outline.
void remove_flat_triangles(CutPart& cut) {
  Eigen::AlignedBox3d box;
  for (const Vec3& v : cut.mesh.vertices) box.extend(v);
  const std::vector<std::uint32_t> group = cut.mesh.group, origin = cut.origin;
  std::iota(cut.mesh.group.begin(), cut.mesh.group.end(), 0U);
  // What diagnose() takes for rounding, and a little more.
  remove_degenerate(cut.mesh, 1.01 * std::ldexp(0.5 * box.sizes().maxCoeff(), -22));
  cut.origin.clear();
  for (std::uint32_t& number : cut.mesh.group) {
    cut.origin.push_back(origin[number]);
    number = group[number];
  }
}

/// The part with another mesh; or why that is no part.
std::string replace_mesh(PlacedMesh& part, CutPart cut) {
  drop_unused_vertices(cut.mesh);
  remove_flat_triangles(cut);
  const MeshDiagnosis diagnosis = diagnose_in_place(cut.mesh);
  const auto unsound = mesh_problems(diagnosis, part.name);
  if (!unsound.empty()) return "afterwards " + unsound.front().what;
  std::vector<std::uint32_t> face_of;
  for (const std::uint32_t own : cut.origin) face_of.push_back(part.face_of[own]);
  part.mesh = std::move(cut.mesh);
  part.face_of = std::move(face_of);
  part.diagnosis = diagnosis;
  return {};
}

}  // namespace

std::string stitch(PlacedMesh& keeper, PlacedMesh& taker, double tolerance_mm, double flat_mm,
                   const Eigen::Matrix3d& axes) {
  const Side keeper_side = side_of(keeper, taker, tolerance_mm, flat_mm),
             taker_side = side_of(taker, keeper, tolerance_mm, flat_mm);
  auto keeper_cut = cut_at_contact(keeper_side, taker_side, tolerance_mm, flat_mm, axes),
       taker_cut = cut_at_contact(taker_side, keeper_side, tolerance_mm, flat_mm, axes);
  if (!keeper_cut || !taker_cut) return "their contact has no plain outline";
  const auto pairs = pairs_of(*keeper_cut, *taker_cut);
  if (!pairs) return "the outlines of their contact do not fit each other";

  double moved = 0.0;
  std::map<std::uint32_t, std::uint32_t> merged;
  std::vector<Knot> knots;
  const std::vector<Loop> keeper_loops = keeper_cut->outlines, taker_loops = taker_cut->outlines;
  for (std::size_t i = 0; i < pairs->size(); ++i) {
    OutlineStitcher stitcher(*keeper_cut, *taker_cut, keeper_loops[(*pairs)[i]], taker_loops[i],
                             tolerance_mm);
    const auto joined = stitcher.stitch(merged, moved);
    if (!joined) return "the outlines of their contact run too far apart";
    knots.insert(knots.end(), joined->begin(), joined->end());
  }
  CutPart rest = without_contact(*taker_cut, merged);
  if (!add_contact(*keeper_cut, taker_side, knots, kPush * tolerance_mm, rest, moved))
    return "a face would move by more than twice the tolerance";

  PlacedMesh new_keeper = keeper, new_taker = taker;
  for (const std::string& why :
       {replace_mesh(new_keeper, std::move(*keeper_cut)), replace_mesh(new_taker, std::move(rest))})
    if (!why.empty()) return why;
  new_taker.notes.push_back(fmt::format(
      "stitched to \"{}\" where they touch within {:.4g} mm and each ends within the other: moved by up to "
      "{:.2g} mm, volume {:.8g} instead of {:.8g} mm3",
      keeper.name, tolerance_mm, moved, new_taker.diagnosis.volume_mm3, taker.diagnosis.volume_mm3));
  keeper = std::move(new_keeper);
  taker = std::move(new_taker);
  return {};
}

}  // namespace scintray
