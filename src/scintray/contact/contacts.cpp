#include "scintray/contact/contacts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "scintray/contact/box_tree.hpp"
#include "scintray/contact/detail/clusters.hpp"
#include "scintray/contact/detail/nesting.hpp"
#include "scintray/contact/detail/overlay.hpp"
#include "scintray/core/activity.hpp"
#include "scintray/core/error.hpp"

namespace scintray::contact {

namespace {

using namespace contact;

/// Coordinates that differ by less than this are equal but for rounding: 64 units in the last place of
/// the largest coordinate, for the few operations that each coordinate goes through.
double rounding_length(const std::vector<PlacedPart>& parts) {
  double largest = 0.0;
  for (const PlacedPart& part : parts)
    for (const core::Vec3& v : part.vertices) largest = std::max(largest, v.cwiseAbs().maxCoeff());
  return 64.0 * std::numeric_limits<double>::epsilon() * largest;
}

void check_tolerance(double tolerance_mm, double rounding_mm) {
  core::Problems problems;
  if (!(tolerance_mm > 0.0) || !std::isfinite(tolerance_mm)) {
    problems.add({}, fmt::format("the contact tolerance is {} mm; it has to be positive", tolerance_mm),
                 "1e-4 mm suits parts of millimetres to metres");
  } else if (tolerance_mm < 10.0 * rounding_mm) {
    problems.add(
        {},
        fmt::format("the contact tolerance of {} mm is below the precision of the coordinates, {:.2g} mm",
                    tolerance_mm, 10.0 * rounding_mm),
        "raise the contact tolerance, or place the parts nearer to the origin");
  }
  problems.throw_if_any();
}

void check_parts(const std::vector<PlacedPart>& parts, const std::vector<Body>& bodies, double tolerance_mm) {
  core::Problems problems;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (!(bodies[i].volume > 0.0)) {
      problems.add(parts[i].where,
                   fmt::format("part '{}' has a volume of {:.6g} mm3", parts[i].name, bodies[i].volume),
                   "the mesh has to be closed, with its triangles counter-clockwise seen from outside");
    } else if (bodies[i].volume <= tolerance_mm * bodies[i].area) {
      problems.add(
          parts[i].where,
          fmt::format("part '{}' is about {:.3g} mm thick (twice its volume by its area), no more than "
                      "twice the contact tolerance of {:.3g} mm, so both its sides would touch",
                      parts[i].name, 2.0 * bodies[i].volume / bodies[i].area, tolerance_mm),
          "lower the contact tolerance, or check the unit of the mesh");
    }
  }
  problems.throw_if_any();
}

/// Largest distance (mm) of a part's facets from the surfaces that they approximate.
double deviation_of(const PlacedPart& part) {
  double largest = 0.0;
  for (std::size_t t = 0; t < part.support.size(); ++t) {
    if (part.support[t] == mesh::kNoSupport) continue;
    const auto& [a, b, c] = part.triangles[t];
    const mesh::FacetDeviation deviation = mesh::facet_deviation(
        part.supports[part.support[t]], {part.vertices[a], part.vertices[b], part.vertices[c]});
    largest = std::max(largest, deviation.distance_mm);
  }
  return largest;
}

/// Assigns to every cell of every surface the regions on its two sides.
class Resolver {
 public:
  Resolver(const std::vector<Body>& bodies, const Nesting& nesting, const Clusters& clusters,
           const std::vector<BodyPair>& pairs, double rounding_mm)
      : bodies_(bodies), nesting_(nesting), clusters_(clusters), rounding_(rounding_mm) {
    group_overlapping(pairs);
  }

  std::vector<InterfaceTriangle> run() {
    for (std::uint32_t b = 0; b < bodies_.size(); ++b)
      for (std::uint32_t t = 0; t < bodies_[b].triangles.size(); ++t)
        if (!id_of_.contains({b, t})) pass({b, t});
    for (std::size_t i = 0; i < groups_.size(); ++i) {
      core::report_activity("overlaying faces that touch", i, groups_.size());
      resolve(groups_[i]);
    }
    return std::move(result_);
  }

 private:
  /// Groups of triangles on one plane, of two or more bodies, connected by overlaps with area.
  void group_overlapping(const std::vector<BodyPair>& pairs) {
    std::vector<std::pair<TriangleOf, TriangleOf>> links;
    for (const BodyPair& pair : pairs)
      for (const auto& [ta, tb] : pair.parallel) {
        const TriangleOf a{pair.a, ta}, b{pair.b, tb};
        const std::int32_t cluster = clusters_.cluster(a);
        if (cluster < 0 || cluster != clusters_.cluster(b)) continue;
        const Plane& plane = clusters_.clusters[static_cast<std::size_t>(cluster)].plane;
        if (overlap(bodies_[a.body], ta, bodies_[b.body], tb, plane).width() > rounding_)
          links.push_back({a, b});
      }
    std::vector<TriangleOf> members;
    for (const auto& [a, b] : links)
      for (const TriangleOf& t : {a, b})
        if (id_of_.try_emplace(t, members.size()).second) members.push_back(t);
    std::vector<std::size_t> root(members.size());
    std::iota(root.begin(), root.end(), std::size_t{0});
    const auto find = [&](std::size_t i) {
      while (root[i] != i) i = root[i] = root[root[i]];
      return i;
    };
    for (const auto& [a, b] : links) {
      const std::pair<std::size_t, std::size_t> ends = std::minmax(find(id_of_.at(a)), find(id_of_.at(b)));
      root[ends.second] = ends.first;
    }
    std::map<std::size_t, std::vector<TriangleOf>> by_root;
    for (std::size_t i = 0; i < members.size(); ++i) by_root[find(i)].push_back(members[i]);
    for (auto& [first, group] : by_root) groups_.push_back(std::move(group));
  }

  /// A triangle that nothing lies on borders the region around its body.
  void pass(const TriangleOf& t) {
    const Body& body = bodies_[t.body];
    if (body.normal[t.triangle].isZero()) return;
    result_.push_back({{body.corner(t.triangle, 0), body.corner(t.triangle, 1), body.corner(t.triangle, 2)},
                       core::PartId(t.body),
                       nesting_.parent(t.body),
                       body.face[t.triangle],
                       core::FaceId::none(),
                       body.support_of(t.triangle),
                       mesh::kNoSupport});
  }

  /// Meaning of a label of the overlay: a face of a body, seen from one side.
  struct Label {
    std::uint32_t body;
    core::FaceId face;
    bool up;  ///< its outward normal points along the plane's normal
    std::uint32_t support;
    auto operator<=>(const Label&) const = default;
  };

  /// Points of a plane: those closer than rounding are one.
  class PlanePoints {
   public:
    PlanePoints(const Plane& plane, double rounding)
        : origin_(plane.origin), frame_(core::Frame::about(plane.normal)), rounding_(rounding) {}

    /// Registers all corners at once, so that the order of merging is that of their coordinates.
    void set(std::vector<core::Vec3> corners) {
      std::vector<Vec2> flat;
      for (const core::Vec3& p : corners)
        flat.emplace_back((p - origin_).dot(frame_.x), (p - origin_).dot(frame_.y));
      std::vector<std::size_t> order(flat.size());
      std::iota(order.begin(), order.end(), std::size_t{0});
      std::stable_sort(order.begin(), order.end(),
                       [&](std::size_t a, std::size_t b) { return flat[a].x() < flat[b].x(); });
      index_.assign(flat.size(), -1);
      for (std::size_t i = 0; i < order.size(); ++i) {
        if (index_[order[i]] >= 0) continue;
        const Vec2& p = flat[order[i]];
        const int id = static_cast<int>(points.size());
        points.push_back(p);
        lifted_.push_back(corners[order[i]]);
        for (std::size_t j = i; j < order.size() && flat[order[j]].x() - p.x() <= rounding_; ++j)
          if (index_[order[j]] < 0 && (flat[order[j]] - p).norm() <= rounding_) index_[order[j]] = id;
      }
    }
    int index(std::size_t corner) const { return index_[corner]; }
    /// Position in space of a point of the overlay, mm.
    core::Vec3 lift(const Overlay& plane, int point) const {
      if (point < static_cast<int>(lifted_.size())) return lifted_[static_cast<std::size_t>(point)];
      const Vec2& p = plane.points[static_cast<std::size_t>(point)];
      return origin_ + p.x() * frame_.x + p.y() * frame_.y;
    }
    std::vector<Vec2> points;

   private:
    core::Vec3 origin_;
    core::Frame frame_;
    double rounding_;
    std::vector<int> index_;
    std::vector<core::Vec3> lifted_;
  };

  void resolve(const std::vector<TriangleOf>& group) {
    const Plane& plane = clusters_.clusters[static_cast<std::size_t>(clusters_.cluster(group.front()))].plane;
    PlanePoints points(plane, rounding_);
    std::vector<core::Vec3> corners;
    std::set<Label> known;
    for (const TriangleOf& t : group) {
      for (int k = 0; k < 3; ++k) corners.push_back(bodies_[t.body].corner(t.triangle, k));
      known.insert(label(t, plane));
    }
    points.set(std::move(corners));
    const std::vector<Label> labels(known.begin(), known.end());
    const Overlay cells = overlay(points.points, edges(group, labels, plane, points));
    for (const OverlayCell& cell : cells.cells) add(cell, cells, points, labels);
  }

  Label label(const TriangleOf& t, const Plane& plane) const {
    const Body& body = bodies_[t.body];
    return {t.body, body.face[t.triangle], body.normal[t.triangle].dot(plane.normal) > 0.0,
            body.support_of(t.triangle)};
  }

  /// The outlines of the labelled faces; sides shared by two triangles of one label cancel. An edge
  /// that passes a corner closer than rounding is split there.
  std::vector<OverlayEdge> edges(const std::vector<TriangleOf>& group, const std::vector<Label>& labels,
                                 const Plane& plane, const PlanePoints& points) const {
    std::map<std::pair<int, int>, std::map<int, int>> windings;
    for (std::size_t i = 0; i < group.size(); ++i) {
      const Label of = label(group[i], plane);
      const int id = static_cast<int>(std::lower_bound(labels.begin(), labels.end(), of) - labels.begin());
      for (std::size_t k = 0; k < 3; ++k) {
        int a = points.index(3 * i + k), b = points.index(3 * i + (k + 1) % 3);
        if (a == b) continue;
        if (!of.up) std::swap(a, b);
        windings[std::minmax(a, b)][id] += a < b ? 1 : -1;
      }
    }
    std::map<std::pair<int, int>, std::map<int, int>> split;
    std::vector<Box> boxes;
    for (const Vec2& p : points.points)
      boxes.push_back(Box{core::Vec3(p.x(), p.y(), 0), core::Vec3(p.x(), p.y(), 0)});
    const BoxTree tree(boxes);
    for (const auto& [ends, winding] : windings) {
      if (std::all_of(winding.begin(), winding.end(), [](const auto& w) { return w.second == 0; })) continue;
      const std::vector<int> chain = through(ends.first, ends.second, points.points, tree);
      for (std::size_t i = 1; i < chain.size(); ++i)
        for (const auto& [id, amount] : winding)
          split[std::minmax(chain[i - 1], chain[i])][id] += chain[i - 1] < chain[i] ? amount : -amount;
    }
    std::vector<OverlayEdge> result;
    for (const auto& [ends, winding] : split) {
      OverlayEdge edge{ends.first, ends.second, {}};
      for (const auto& w : winding)
        if (w.second != 0) edge.winding.push_back(w);
      if (!edge.winding.empty()) result.push_back(std::move(edge));
    }
    return result;
  }

  /// The points on the edge from a to b, in order, both ends included.
  std::vector<int> through(int a, int b, const std::vector<Vec2>& points, const BoxTree& tree) const {
    const Vec2& from = points[static_cast<std::size_t>(a)];
    const Vec2 edge = points[static_cast<std::size_t>(b)] - from;
    const double length = edge.norm();
    std::vector<std::pair<double, int>> on{{0.0, a}, {length, b}};
    Box box = tree.box(static_cast<std::uint32_t>(a));
    box.add(tree.box(static_cast<std::uint32_t>(b)));
    for (const std::uint32_t i : tree.touching(box.grown(rounding_))) {
      const Vec2 v = points[i] - from;
      const double along = v.dot(edge) / length, off = (v.x() * edge.y() - v.y() * edge.x()) / length;
      if (static_cast<int>(i) != a && static_cast<int>(i) != b && along > 0.0 && along < length &&
          std::abs(off) <= rounding_)
        on.emplace_back(along, static_cast<int>(i));
    }
    std::sort(on.begin(), on.end());
    std::vector<int> chain;
    for (const auto& entry : on) chain.push_back(entry.second);
    return chain;
  }

  struct Place {
    core::PartId region = kAmbient;
    core::FaceId face;
    std::uint32_t support = mesh::kNoSupport;
  };

  /// The region on one side of a cell: the innermost body that ends here with its inside on that side,
  /// else the innermost body around those that end here.
  Place side(const std::vector<int>& covering, const std::vector<Label>& labels, bool above) const {
    const Label* best = nullptr;
    for (const int id : covering) {
      const Label& l = labels[static_cast<std::size_t>(id)];
      if (l.up != above && (best == nullptr || nesting_.depth(l.body) > nesting_.depth(best->body)))
        best = &l;
    }
    if (best != nullptr) return {core::PartId(best->body), best->face, best->support};
    Place place;
    for (const int id : covering)
      for (const std::uint32_t outer : nesting_.around[labels[static_cast<std::size_t>(id)].body]) {
        const bool ends_here = std::any_of(covering.begin(), covering.end(), [&](int other) {
          return labels[static_cast<std::size_t>(other)].body == outer;
        });
        if (ends_here) continue;
        if (place.region == kAmbient || nesting_.depth(outer) > nesting_.depth(place.region.index()))
          place.region = core::PartId(outer);
      }
    return place;
  }

  void add(const OverlayCell& cell, const Overlay& cells, const PlanePoints& points,
           const std::vector<Label>& labels) {
    const Place below = side(cell.labels, labels, false), above = side(cell.labels, labels, true);
    if (below.region == above.region) return;
    InterfaceTriangle triangle;
    for (std::size_t k = 0; k < 3; ++k) triangle.vertex[k] = points.lift(cells, cell.point[k]);
    const core::Vec3 e1 = triangle.vertex[1] - triangle.vertex[0],
                     e2 = triangle.vertex[2] - triangle.vertex[0];
    const double longest = std::max({e1.norm(), e2.norm(), (e1 - e2).norm()});
    // Three edges that intersect in one point but for rounding: neither area nor a normal.
    if (e1.cross(e2).norm() <= 0.1 * rounding_ * longest) return;
    // The back is the side that ends here; of two, the earlier part.
    const bool flip = !below.face.has_value() || (above.face.has_value() && above.region < below.region);
    if (flip) std::swap(triangle.vertex[1], triangle.vertex[2]);
    const Place& back = flip ? above : below;
    const Place& front = flip ? below : above;
    triangle.back = back.region;
    triangle.back_face = back.face;
    triangle.front = front.region;
    triangle.front_face = front.face;
    triangle.back_support = back.support;
    triangle.front_support = front.support;
    result_.push_back(triangle);
  }

  const std::vector<Body>& bodies_;
  const Nesting& nesting_;
  const Clusters& clusters_;
  double rounding_;
  std::map<TriangleOf, std::size_t> id_of_;  ///< of the triangles in groups
  std::vector<std::vector<TriangleOf>> groups_;
  std::vector<InterfaceTriangle> result_;
};

}  // namespace

std::string also_at(const std::string& name, const core::FileLocation& where,
                    const core::FileLocation& reported) {
  const std::string place = where.text();
  return place.empty() || place == reported.text() ? "" : "; '" + name + "' is at " + place;
}

void refuse_overlaps(const std::vector<PlacedPart>& parts, const std::vector<OverlappingPair>& pairs,
                     double tolerance_mm) {
  core::Problems problems;
  for (const OverlappingPair& pair : pairs) {
    const OverlapVolume common = overlap_volume(parts[pair.a], parts[pair.b]);
    const std::string how =
        common.exact ? "" : fmt::format(" (counted on a grid of {} points)", kOverlapGridPoints);
    const PlacedPart &a = parts[pair.a], &b = parts[pair.b];
    problems.add(
        a.where,
        fmt::format("parts '{}' and '{}' overlap by {}{:.6g} mm3{}, for example at ({:.6g}, {:.6g}, "
                    "{:.6g}) mm; parts may touch or lie one wholly inside the other{}",
                    a.name, b.name, common.exact ? "" : "about ", common.volume_mm3, how, common.inside.x(),
                    common.inside.y(), common.inside.z(), also_at(b.name, b.where, a.where)),
        fmt::format("move one of them, or give the one that is to keep the space a higher priority; faces "
                    "meant to touch may miss each other by the contact tolerance, {:.3g} mm{}",
                    tolerance_mm,
                    a.supports.empty() && b.supports.empty()
                        ? ""
                        : "; where round parts have one wall in common but their facets there cannot be made "
                          "the same, "
                          "give both the same number of segments and the same turn about their axis"),
        {{common.inside.x(), common.inside.y(), common.inside.z()}});
  }
  problems.throw_if_any();
}

std::vector<InterfaceTriangle> resolve_contacts(const std::vector<PlacedPart>& parts, double tolerance_mm,
                                                std::vector<OverlappingPair>* by_facets) {
  const double rounding = rounding_length(parts);
  check_tolerance(tolerance_mm, rounding);
  core::report_activity("looking for parts that touch");
  const Eigen::Matrix3d axes = natural_axes(parts);
  std::vector<Body> bodies;
  for (const PlacedPart& part : parts) bodies.emplace_back(part, axes);
  check_parts(parts, bodies, tolerance_mm);

  // Snapping moves a corner by up to twice the tolerance for each of the up to three faces it is on;
  // pairs found within this reach stay valid after it.
  const std::vector<BodyPair> pairs = near_pairs(bodies, 8.0 * tolerance_mm);
  const Clusters clusters = find_clusters(bodies, parts, pairs, tolerance_mm);
  snap(bodies, clusters, tolerance_mm, rounding);
  core::report_activity("looking for parts inside others");
  std::vector<double> deviation_mm;
  for (const PlacedPart& part : parts) deviation_mm.push_back(deviation_of(part));
  Nesting nesting = find_nesting(bodies, pairs, tolerance_mm, deviation_mm);
  if (by_facets == nullptr)
    nesting.overlaps.insert(nesting.overlaps.end(), nesting.by_facets.begin(), nesting.by_facets.end());
  else
    *by_facets = nesting.by_facets;
  refuse_overlaps(parts, nesting.overlaps, tolerance_mm);
  return Resolver(bodies, nesting, clusters, pairs, rounding).run();
}

}  // namespace scintray::contact
