#include <algorithm>
#include <cmath>
#include <map>

#include "scintray/mesh/triangle_distance.hpp"
#include "scintray/scene/detail/round_parts.hpp"

namespace scintray::scene {

namespace {

/// The surface of a triangle of a part: the one that it approximates, or its plane.
struct FaceSurface {
  const mesh::SupportSurface* round = nullptr;
  core::Vec3 normal = core::Vec3::Zero(), through = core::Vec3::Zero();  ///< of the plane

  mesh::Foot nearest(const core::Vec3& point) const {
    if (round) return round->nearest(point);
    return {normal.dot(through - point) * normal, normal};
  }
  core::Vec3 onto(core::Vec3 point) const {
    for (int step = 0; step < 5; ++step) point += nearest(point).step;
    return point;
  }
};

/// The point of the curve in which two surfaces intersect, next to a point: steps of Newton's method in the
/// plane of both normals. Nothing where the surfaces are tangent there.
std::optional<core::Vec3> onto_both(const FaceSurface& a, const FaceSurface& b, core::Vec3 point) {
  constexpr int kMostSteps = 30;
  constexpr double kTangent = 1e-3;  // squared sine of the angle between them
  for (int step = 0; step < kMostSteps; ++step) {
    const mesh::Foot to_a = a.nearest(point), to_b = b.nearest(point);
    const double cosine = to_a.normal.dot(to_b.normal), determinant = 1.0 - cosine * cosine;
    if (!(determinant > kTangent)) return std::nullopt;
    const double along_a = to_a.step.dot(to_a.normal), along_b = to_b.step.dot(to_b.normal);
    const core::Vec3 move =
        ((along_a - cosine * along_b) * to_a.normal + (along_b - cosine * along_a) * to_b.normal) /
        determinant;
    point += move;
    if (move.norm() <= 1e-15 * (1.0 + point.norm())) break;
  }
  return point;
}

double tetrahedron(const core::Vec3& origin, const Corners& t) {
  return (t[0] - origin).dot((t[1] - origin).cross(t[2] - origin)) / 6.0;
}

/// Triangles of a part, or of a region's interfaces with it, and what is on the other side of their sides.
class RoundEdges {
 public:
  RoundEdges(const std::vector<SurfaceTriangle>& triangles, const std::vector<mesh::SupportSurface>& supports)
      : triangles_(triangles), supports_(supports) {
    for (const SurfaceTriangle& t : triangles_)
      for (const core::Vec3& corner : t.corners) box_.extend(corner);
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) at_[{key(corner(t, k)), key(corner(t, k + 1))}] = t;
    join_divided_sides();
  }

  std::vector<std::array<mesh::PatchExcess, 3>> excess() const {
    std::vector<std::array<mesh::PatchExcess, 3>> result(triangles_.size());
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        if (const std::optional<FaceSurface> other = beyond(t, k)) result[t][k] = excess_at(t, k, *other);
    return result;
  }

  /// The extremes along each axis are at corners, on sides of the patches, or where a surface's normal is
  /// along the axis.
  Eigen::AlignedBox3d bounds() {
    find_moved_corners();
    Eigen::AlignedBox3d box = box_;
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      if (triangles_[t].support == mesh::kNoSupport || is_degenerate(t)) continue;
      for (std::size_t k = 0; k < 3; ++k) add_side(t, k, box);
    }
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      if (triangles_[t].support == mesh::kNoSupport || is_degenerate(t)) continue;
      const mesh::SupportSurface& surface = supports_[triangles_[t].support];
      const std::vector<core::Vec3> all = poles(surface);
      for (std::size_t i = 0; i < all.size(); ++i) {
        if (box.contains(all[i])) continue;
        const auto& [a, b, c] = triangles_[t].corners;
        const double off = mesh::facet_deviation(surface, triangles_[t].corners).distance_mm;
        if (mesh::distance_to_triangle(all[i], a, b, c) <= 1.5 * off) box.extend(all[i]);
      }
    }
    return box;
  }

 private:
  using Key = std::array<double, 3>;
  static Key key(const core::Vec3& v) { return {v.x() + 0.0, v.y() + 0.0, v.z() + 0.0}; }
  /// Where a contact divided one side of an edge, finds for each piece, and for the whole, a triangle beyond
  /// it.
  void join_divided_sides() {
    struct Side {
      std::size_t t, k;
    };
    std::vector<Side> round, flat;  // without a triangle beyond them
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      if (is_degenerate(t)) continue;
      for (std::size_t k = 0; k < 3; ++k)
        if (!at_.contains({key(corner(t, k + 1)), key(corner(t, k))}))
          (triangles_[t].support == mesh::kNoSupport ? flat : round).push_back({t, k});
    }
    const double near = 1e-9 * box_.diagonal().norm();
    const auto is_within = [&](const core::Vec3& point, const Side& side) {
      return mesh::distance_to_segment(point, corner(side.t, side.k), corner(side.t, side.k + 1)) <= near;
    };
    const auto along = [&](const Side& side) {
      return core::Vec3(corner(side.t, side.k + 1) - corner(side.t, side.k));
    };
    for (const Side& a : round)
      for (const Side& b : flat) {
        if (along(a).dot(along(b)) > -0.5 * along(a).norm() * along(b).norm()) continue;
        const bool shares = is_within(0.5 * (corner(a.t, a.k) + corner(a.t, a.k + 1)), b) ||
                            is_within(0.5 * (corner(b.t, b.k) + corner(b.t, b.k + 1)), a);
        if (!shares) continue;
        at_[{key(corner(a.t, a.k + 1)), key(corner(a.t, a.k))}] = b.t;
        at_[{key(corner(b.t, b.k + 1)), key(corner(b.t, b.k))}] = a.t;
      }
  }

  /// The corners of edges that are not on them, in the middle of a side that a contact cut, and their places
  /// there.
  void find_moved_corners() {
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::optional<FaceSurface> other = beyond(t, k);
        if (!other) continue;
        for (const core::Vec3& end : {corner(t, k), corner(t, k + 1)}) {
          const std::optional<core::Vec3> place = onto_both(surface(t), *other, end);
          if (place && (*place - end).norm() > 1e-9 * box_.diagonal().norm()) moved_[key(end)] = *place;
        }
      }
  }
  const core::Vec3& true_corner(std::size_t t, std::size_t k) const {
    const auto moved = moved_.find(key(corner(t, k)));
    return moved == moved_.end() ? corner(t, k) : moved->second;
  }
  const core::Vec3& corner(std::size_t t, std::size_t k) const { return triangles_[t].corners[k % 3]; }
  bool is_degenerate(std::size_t t) const { return doubled_area(triangles_[t].corners).isZero(0.0); }

  FaceSurface surface(std::size_t t) const {
    const SurfaceTriangle& own = triangles_[t];
    if (own.support != mesh::kNoSupport) return {&supports_[own.support], {}, {}};
    return {nullptr, doubled_area(own.corners).normalized(), own.corners[0]};
  }

  /// The surface beyond a side that is an edge between two surfaces, one of them round.
  std::optional<FaceSurface> beyond(std::size_t t, std::size_t k) const {
    const auto found = at_.find({key(corner(t, k + 1)), key(corner(t, k))});
    if (found == at_.end() || is_degenerate(t) || is_degenerate(found->second)) return std::nullopt;
    if (triangles_[t].support == triangles_[found->second].support) return std::nullopt;
    return surface(found->second);
  }

  mesh::PatchExcess excess_at(std::size_t t, std::size_t k, const FaceSurface& other) const {
    const FaceSurface own = surface(t);
    const core::Vec3 &from = corner(t, k), &to = corner(t, k + 1), &opposite = corner(t, k + 2);
    const std::optional<core::Vec3> middle = onto_both(own, other, 0.5 * (from + to));
    if (!middle) return own.round ? mesh::PatchExcess{} : segment_alone(own, other, from, to);
    // Patches above triangles end on the edge where this is the projection of the side.
    const core::Vec3 chord = 0.5 * (from + to);
    const auto ends_there = [&](const FaceSurface& of) {
      if (!of.round) return true;
      const core::Vec3 centre = of.round->middle(chord);
      return (*middle - centre).cross(chord - centre).norm() <= 1e-12 * box_.diagonal().squaredNorm();
    };
    if (ends_there(own) && ends_there(other))
      return own.round ? mesh::PatchExcess{} : segment_alone(own, other, from, to);
    const Corners whole{from, to, opposite};
    const mesh::PatchExcess plain = content(own, other, whole, false);
    const auto divided = [&](int pieces) {
      mesh::PatchExcess sum{-plain.area_mm2, -plain.volume_mm3};
      core::Vec3 last = from;
      for (int i = 1; i <= pieces; ++i) {
        core::Vec3 next = to;
        if (i < pieces) {
          const core::Vec3 on_chord = from + static_cast<double>(i) / pieces * (to - from);
          next = onto_both(own, other, on_chord).value_or(own.onto(on_chord));
        }
        const mesh::PatchExcess piece = content(own, other, {last, next, opposite}, true);
        sum.area_mm2 += piece.area_mm2;
        sum.volume_mm3 += piece.volume_mm3;
        last = next;
      }
      return sum;
    };
    // The error goes with the square of the pieces' length (Richardson's extrapolation).
    const mesh::PatchExcess coarse = divided(4), fine = divided(8);
    return {(4.0 * fine.area_mm2 - coarse.area_mm2) / 3.0, (4.0 * fine.volume_mm3 - coarse.volume_mm3) / 3.0};
  }

  static mesh::PatchExcess segment_alone(const FaceSurface& own, const FaceSurface& other,
                                         const core::Vec3& from, const core::Vec3& to) {
    return {mesh::segment_area(*other.round, own.normal, from, to), 0.0};
  }

  /// Area of a triangle, or of the patch above it, and volume of its cone from the middle of the box.
  mesh::PatchExcess content(const FaceSurface& own, const FaceSurface& other, const Corners& t,
                            bool with_segment) const {
    mesh::PatchExcess result{0.0, tetrahedron(box_.center(), t)};
    if (own.round) {
      const mesh::PatchExcess patch = mesh::patch_excess(*own.round, t);
      result.area_mm2 = 0.5 * doubled_area(t).norm() + patch.area_mm2;
      result.volume_mm3 += patch.volume_mm3;
    } else {
      result.area_mm2 = 0.5 * doubled_area(t).dot(own.normal);
      if (with_segment) result.area_mm2 += segment_alone(own, other, t[0], t[1]).area_mm2;
    }
    return result;
  }

  /// Extends the box to the extremes of the curve above a side.
  void add_side(std::size_t t, std::size_t k, Eigen::AlignedBox3d& box) const {
    const FaceSurface own = surface(t);
    const std::optional<FaceSurface> other = beyond(t, k);
    const core::Vec3 &from = true_corner(t, k), &to = true_corner(t, k + 1);
    const auto point_at = [&](double share) {
      const core::Vec3 chord = from + share * (to - from);
      return (other ? onto_both(own, *other, chord) : std::nullopt).value_or(own.onto(chord));
    };
    const core::Vec3 bulge = 2.0 * (point_at(0.5) - 0.5 * (from + to)).cwiseAbs();
    for (int axis = 0; axis < 3; ++axis)
      for (const double sign : {-1.0, 1.0}) {
        const double reach = std::max(sign * from[axis], sign * to[axis]) + bulge[axis];
        const double limit = sign > 0.0 ? box.max()[axis] : -box.min()[axis];
        if (!(reach > limit + 1e-12 * box_.diagonal().norm())) continue;
        box.extend(point_at(highest([&](double share) { return sign * point_at(share)[axis]; })));
      }
  }

  /// Place of the maximum on [0, 1] of a function that has one there, by golden sections.
  template <typename Function>
  static double highest(const Function& function) {
    constexpr double kGolden = 0.6180339887498949;
    constexpr int kSections = 40;  // to 4e-9, and the maximum to its square
    double low = 0.0, high = 1.0;
    double a = high - kGolden, b = low + kGolden, at_a = function(a), at_b = function(b);
    for (int i = 0; i < kSections; ++i) {
      if (at_a > at_b) {
        high = b, b = a, at_b = at_a;
        at_a = function(a = high - kGolden * (high - low));
      } else {
        low = a, a = b, at_a = at_b;
        at_b = function(b = low + kGolden * (high - low));
      }
    }
    return 0.5 * (low + high);
  }

  /// The isolated points of a surface whose normal is along x, y or z.
  static std::vector<core::Vec3> poles(const mesh::SupportSurface& s) {
    std::vector<core::Vec3> result;
    const core::Vec3 origin = s.origin.vec(), along = s.axis.vec();
    for (int axis = 0; axis < 3; ++axis) {
      const core::Vec3 e = core::Vec3::Unit(axis);
      const double ez = e.dot(along);
      const core::Vec3 across = e - ez * along;
      if (s.is_torus()) {
        if (!(across.norm() > 1e-12)) continue;  // a circle, on the sides of its facets
        for (const double circle : {-s.major, s.major})
          for (const double tube : {-std::sqrt(s.radius2), std::sqrt(s.radius2)})
            result.push_back(origin + circle * across.normalized() + tube * e);
      } else if (s.axial != 0.0) {
        // Half the gradient, rho + (axial z - slope) axis, is m e.
        const double m2 =
            (s.radius2 + s.slope * s.slope / s.axial) / (across.squaredNorm() + ez * ez / s.axial);
        if (!(m2 > 0.0) || !std::isfinite(m2)) continue;
        for (const double m : {-std::sqrt(m2), std::sqrt(m2)})
          result.push_back(origin + m * across + (s.slope + m * ez) / s.axial * along);
      } else if (s.slope != 0.0 && std::abs(ez) > 1e-12) {
        const core::Vec3 rho = -s.slope / ez * across;
        result.push_back(origin + rho + (rho.squaredNorm() - s.radius2) / (2.0 * s.slope) * along);
      }
    }
    return result;
  }

  const std::vector<SurfaceTriangle>& triangles_;
  const std::vector<mesh::SupportSurface>& supports_;
  Eigen::AlignedBox3d box_;
  std::map<std::pair<Key, Key>, std::size_t> at_;  ///< triangle by its directed side
  std::map<Key, core::Vec3> moved_;  ///< corners that are not on their edges, and their places there
};

}  // namespace

std::vector<std::array<mesh::PatchExcess, 3>> edge_excess(const std::vector<SurfaceTriangle>& triangles,
                                                          const std::vector<mesh::SupportSurface>& supports) {
  return RoundEdges(triangles, supports).excess();
}

Eigen::AlignedBox3d exact_bounds(const std::vector<SurfaceTriangle>& triangles,
                                 const std::vector<mesh::SupportSurface>& supports) {
  return RoundEdges(triangles, supports).bounds();
}

}  // namespace scintray::scene
