#include "scintray/contact/detail/stitch.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "scintray/mesh/triangle_distance.hpp"

namespace scintray::contact {

namespace {

constexpr double kSame = 0.05;  // in tolerances: outline corners this near to each other are one

/// A closed line with points on it given by the path length along it.
class Outline {
 public:
  Outline(const mesh::TriMesh& mesh, const Loop& loop) {
    for (const std::uint32_t v : loop) corners_.push_back(mesh.vertices[v]);
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      starts_.push_back(length_);
      length_ += (corner(i + 1) - corner(i)).norm();
    }
  }

  struct Place {
    double along = 0.0, distance = HUGE_VAL;
  };
  Place nearest(const core::Vec3& p) const {
    Place best;
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const core::Vec3 edge = corner(i + 1) - corner(i);
      const double share = mesh::share_along_segment(p, corner(i), corner(i + 1));
      const double d = (p - (corner(i) + share * edge)).norm();
      if (d < best.distance) best = {starts_[i] + share * edge.norm(), d};
    }
    return best;
  }
  double length() const { return length_; }
  double start(std::size_t i) const { return starts_[i]; }
  std::size_t size() const { return corners_.size(); }
  const core::Vec3& corner(std::size_t i) const { return corners_[i % corners_.size()]; }
  core::Vec3 at(std::size_t edge, double along) const {
    const core::Vec3 whole = corner(edge + 1) - corner(edge);
    return corner(edge) + whole * ((along - starts_[edge]) / whole.norm());
  }

 private:
  std::vector<core::Vec3> corners_;
  std::vector<double> starts_;
  double length_ = 0.0;
};

/// The common outline of two.
class OutlineStitcher {
 public:
  OutlineStitcher(OutlineStitching& parts, const Loop& reference_loop, const Loop& conforming_loop)
      : reference_(parts.reference),
        conforming_(parts.conforming),
        merged_(parts.merged),
        moved_(parts.moved),
        reference_loop_(reference_loop.rbegin(),
                        reference_loop.rend()),  // in the opposite sense, as seen from here
        conforming_loop_(conforming_loop),
        outline_(reference_.mesh, reference_loop_),
        reach_(kContactPush * parts.tolerance),
        same_(kSame * parts.tolerance) {}

  /// The common outline; empty where the two are too far apart or in another order. Moves the conforming
  /// side's corners and cuts edges of both.
  std::optional<std::vector<Knot>> stitch() {
    if (!place_corners()) return std::nullopt;
    make_knots();
    if (!move_conforming()) return std::nullopt;
    cut_reference();
    return knots_;
  }

 private:
  /// Finds the positions of the conforming side's corners along the reference side's outline, each after the
  /// one before.
  bool place_corners() {
    for (const std::uint32_t v : conforming_loop_) {
      const Outline::Place place = outline_.nearest(conforming_.mesh.vertices[v]);
      if (place.distance > reach_) return false;
      moved_ = std::max(moved_, place.distance);
      places_.push_back(snapped(place.along));
    }
    double turn = 0.0;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      double& next = places_[(i + 1) % places_.size()];
      double step = next - places_[i];
      if (step < 0.0) step += outline_.length();
      if (outline_.length() - step <= same_) {  // slightly backwards
        next = places_[i];
        step = 0.0;
      }
      turn += step;
    }
    return std::abs(turn - outline_.length()) <= 1e-6 * outline_.length();
  }

  /// The corner of the outline within reach, if there is one.
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
      knots_.push_back({start, outline_.corner(edge), reference_loop_[edge], ~0U});
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

  bool move_conforming() {
    std::vector<std::size_t> knot_of;
    for (const double along : places_) knot_of.push_back(knot_at(along));
    const std::vector<core::Vec3> before = conforming_.mesh.vertices;
    for (std::size_t i = 0; i < conforming_loop_.size(); ++i) {
      Knot& knot = knots_[knot_of[i]];
      if (knot.of_conforming == ~0U)
        knot.of_conforming = conforming_loop_[i];
      else if (knot.of_conforming != conforming_loop_[i])
        merged_[conforming_loop_[i]] = knot.of_conforming;
      conforming_.mesh.vertices[conforming_loop_[i]] = knot.position;
    }
    for (std::size_t i = 0; i < conforming_loop_.size(); ++i) {
      const std::size_t end = knot_of[(i + 1) % knot_of.size()];
      const std::uint32_t last = conforming_loop_[(i + 1) % conforming_loop_.size()];
      std::uint32_t from = conforming_loop_[i];
      if (end == knot_of[i]) continue;
      for (std::size_t k = (knot_of[i] + 1) % knots_.size(); k != end; k = (k + 1) % knots_.size()) {
        const double off =
            mesh::distance_to_segment(knots_[k].position, before[conforming_loop_[i]], before[last]);
        if (off > reach_ || knots_[k].of_conforming != ~0U) return false;
        moved_ = std::max(moved_, off);
        knots_[k].of_conforming = add_vertex(conforming_.mesh, knots_[k].position);
        split_edge(conforming_, from, last, knots_[k].of_conforming);
        from = knots_[k].of_conforming;
      }
    }
    return true;
  }

  void cut_reference() {
    for (std::size_t k = 0; k < knots_.size(); ++k) {
      if (knots_[k].of_reference != ~0U) continue;
      std::size_t end = k;
      while (knots_[end % knots_.size()].of_reference == ~0U) ++end;
      knots_[k].of_reference = add_vertex(reference_.mesh, knots_[k].position);
      split_edge(reference_, knots_[(k + knots_.size() - 1) % knots_.size()].of_reference,
                 knots_[end % knots_.size()].of_reference, knots_[k].of_reference);
    }
  }

  CutPart &reference_, &conforming_;
  std::map<std::uint32_t, std::uint32_t>& merged_;
  double& moved_;
  Loop reference_loop_, conforming_loop_;
  Outline outline_;
  double reach_, same_;
  std::vector<double> places_;  ///< of the conforming side's corners, along the outline
  std::vector<Knot> knots_;
};

}  // namespace

std::optional<std::vector<Knot>> stitch_outlines(OutlineStitching& parts, const Loop& reference_loop,
                                                 const Loop& conforming_loop) {
  return OutlineStitcher(parts, reference_loop, conforming_loop).stitch();
}

std::optional<std::vector<std::size_t>> outline_pairs(const CutPart& reference, const CutPart& conforming) {
  if (reference.outlines.size() != conforming.outlines.size() || reference.outlines.empty())
    return std::nullopt;
  std::vector<std::size_t> pairs;
  for (const Loop& loop : conforming.outlines) {
    std::size_t best = 0;
    double least = HUGE_VAL;
    for (std::size_t k = 0; k < reference.outlines.size(); ++k) {
      const Outline outline(reference.mesh, reference.outlines[k]);
      double farthest = 0.0;
      for (const std::uint32_t v : loop)
        farthest = std::max(farthest, outline.nearest(conforming.mesh.vertices[v]).distance);
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

}  // namespace scintray::contact
