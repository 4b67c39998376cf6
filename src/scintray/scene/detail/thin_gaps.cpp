#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "scintray/contact/box_tree.hpp"
#include "scintray/scene/detail/flat_faces.hpp"

namespace scintray::scene {

namespace {

/// A gap is thin below this share of both sides of its box: most rays then reach the face beyond (chosen).
constexpr double kThin = 0.25;
/// A box ends this much, relative to the region's size, before its face does, so that rounding does not
/// matter.
constexpr double kInside = 1e-8;
/// Relative difference of areas up to which a face is its bounding rectangle.
constexpr double kSameArea = 1e-9;
constexpr std::size_t kMostDirections = 256;
constexpr std::size_t kMostGapsOfFace = 16;

struct Rectangle {
  core::Vec3 x, y;
  Eigen::AlignedBox2d sides;
};

Eigen::Vector2d in_plane(const core::Vec3& x, const core::Vec3& y, const core::Vec3& point) {
  return {x.dot(point), y.dot(point)};
}

Eigen::AlignedBox2d bounds_in(const core::Vec3& x, const core::Vec3& y, const FlatFace& face,
                              const Boundary& boundary) {
  Eigen::AlignedBox2d bounds;
  for (const std::uint32_t triangle : face.triangles)
    for (const core::Vec3& corner : boundary.triangle(triangle)) bounds.extend(in_plane(x, y, corner));
  return bounds;
}

/// The rectangle that a flat face is, if it is one: along a side of one of its first triangles.
std::optional<Rectangle> rectangle_of(const FlatFace& face, const Boundary& boundary) {
  constexpr std::size_t kFirst = 4;
  const double area = area_of(face, boundary);
  for (std::size_t i = 0; i < std::min(kFirst, face.triangles.size()); ++i) {
    const BoundaryTriangle corners = boundary.triangle(face.triangles[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      const core::Vec3 x = (corners[(k + 1) % 3] - corners[k]).normalized();
      const core::Vec3 y = face.normal.cross(x).normalized();
      const Eigen::AlignedBox2d sides = bounds_in(x, y, face, boundary);
      if (std::abs(sides.volume() - area) <= kSameArea * area) return Rectangle{x, y, sides};
    }
  }
  return std::nullopt;
}

/// Whether a triangle has no point in common with a box about the origin, by the separating axes of both.
bool apart(const BoundaryTriangle& triangle, const core::Vec3& half) {
  const auto separates = [&](const core::Vec3& axis) {
    const double reach = half.dot(axis.cwiseAbs());
    const double a = axis.dot(triangle[0]), b = axis.dot(triangle[1]), c = axis.dot(triangle[2]);
    return std::min({a, b, c}) > reach || std::max({a, b, c}) < -reach;
  };
  const std::array<core::Vec3, 3> edges{triangle[1] - triangle[0], triangle[2] - triangle[1],
                                        triangle[0] - triangle[2]};
  for (int axis = 0; axis < 3; ++axis) {
    if (separates(core::Vec3::Unit(axis))) return true;
    for (const core::Vec3& edge : edges)
      if (separates(core::Vec3::Unit(axis).cross(edge))) return true;
  }
  return separates(edges[0].cross(edges[1]));
}

/// Search for gaps among the flat faces of a region.
class GapSearch {
 public:
  GapSearch(const Boundary& boundary, const std::vector<FlatFace>& faces)
      : boundary_(boundary), faces_(faces), inside_(kInside * boundary.size_mm) {
    for (const FlatFace& face : faces_) rectangles_.push_back(rectangle_of(face, boundary));
  }

  ThinGaps find() {
    ThinGaps found;
    std::vector<std::vector<Candidate>> from(faces_.size());
    for (const std::vector<Placed>& along : by_direction()) pair(along, from);
    for (std::size_t face = 0; face < faces_.size(); ++face) {
      std::vector<Candidate>& candidates = from[face];
      if (candidates.empty()) continue;
      std::stable_sort(candidates.begin(), candidates.end(),
                       [](const Candidate& a, const Candidate& b) { return a.common_mm2 > b.common_mm2; });
      if (candidates.size() > kMostGapsOfFace) candidates.resize(kMostGapsOfFace);
      const auto begin = static_cast<std::uint32_t>(found.gaps.size());
      for (const Candidate& candidate : candidates) found.gaps.push_back(candidate.gap);
      const auto end = static_cast<std::uint32_t>(found.gaps.size());
      found.of_triangle.resize(boundary_.size());
      for (const std::uint32_t triangle : faces_[face].triangles) found.of_triangle[triangle] = {begin, end};
    }
    return found;
  }

 private:
  /// A face on an axis along which several lie.
  struct Placed {
    double at_mm = 0.0;
    bool forward = false;  ///< its normal points along the axis
    std::size_t face = 0;
  };
  struct Candidate {
    ThinGap gap;
    double common_mm2 = 0.0;  ///< of the two faces, projected
  };

  /// The faces by the axis of their normals, in order of place.
  std::vector<std::vector<Placed>> by_direction() const {
    std::vector<core::Vec3> axes;
    std::vector<std::vector<Placed>> placed;
    for (std::size_t face = 0; face < faces_.size(); ++face) {
      const core::Vec3& normal = faces_[face].normal;
      const auto axis = std::find_if(axes.begin(), axes.end(), [&](const core::Vec3& known) {
        return known.cross(normal).norm() <= kCoplanar;
      });
      if (axis == axes.end() && axes.size() == kMostDirections) continue;
      const auto number = static_cast<std::size_t>(axis - axes.begin());
      if (axis == axes.end()) {
        axes.push_back(normal);
        placed.emplace_back();
      }
      const bool forward = axes[number].dot(normal) > 0.0;
      placed[number].push_back({forward ? faces_[face].offset : -faces_[face].offset, forward, face});
    }
    for (std::vector<Placed>& along : placed)
      std::stable_sort(along.begin(), along.end(),
                       [](const Placed& a, const Placed& b) { return a.at_mm < b.at_mm; });
    return placed;
  }

  /// Adds the gaps between each face that looks backward and the faces after it that look forward.
  void pair(const std::vector<Placed>& along, std::vector<std::vector<Candidate>>& from) {
    for (std::size_t i = 0; i < along.size(); ++i) {
      if (along[i].forward) continue;
      const double widest = kThin * widest_side(along[i].face);
      for (std::size_t k = i + 1; k < along.size() && along[k].at_mm - along[i].at_mm <= widest; ++k) {
        const double height = along[k].at_mm - along[i].at_mm;
        if (!along[k].forward || !(height > 2.0 * inside_)) continue;
        add(along[i].face, along[k].face, height, from);
        add(along[k].face, along[i].face, height, from);
      }
    }
  }

  double widest_side(std::size_t face) const {
    Eigen::AlignedBox3d bounds;
    for (const std::uint32_t triangle : faces_[face].triangles)
      for (const core::Vec3& corner : boundary_.triangle(triangle)) bounds.extend(corner);
    return bounds.diagonal().norm();
  }

  /// Adds the gap that rays cross from one face to another, if it is clear and thin.
  void add(std::size_t start, std::size_t beyond, double height, std::vector<std::vector<Candidate>>& from) {
    const std::optional<Rectangle>& rectangle = rectangles_[beyond];
    if (!rectangle || from[start].size() > kMostGapsOfFace) return;
    const core::Vec3 &x = rectangle->x, &y = rectangle->y;
    const Eigen::AlignedBox2d common =
        rectangle->sides.intersection(bounds_in(x, y, faces_[start], boundary_));
    if (common.isEmpty() || height > kThin * common.sizes().minCoeff()) return;
    const auto add_box = [&](const Eigen::AlignedBox2d& sides, double common_mm2) {
      from[start].push_back({{x, y, sides.min().x(), sides.max().x(), sides.min().y(), sides.max().y(),
                              faces_[beyond].triangles.front()},
                             common_mm2});
    };
    Eigen::AlignedBox2d in_the_way;
    for (const Eigen::AlignedBox2d& sides : {inside(rectangle->sides), inside(common)}) {
      in_the_way = obstacle(*rectangle, sides, faces_[beyond], height);
      if (in_the_way.isEmpty()) return add_box(sides, common.volume());
    }
    // Beside it, as below a septum that ends before the crystals do.
    for (int axis = 0; axis < 2; ++axis) {
      for (const bool before : {true, false}) {
        Eigen::AlignedBox2d rest = common;
        (before ? rest.max() : rest.min())[axis] = (before ? in_the_way.min() : in_the_way.max())[axis];
        if (rest.isEmpty() || height > kThin * rest.sizes().minCoeff()) continue;
        const Eigen::AlignedBox2d sides = inside(rest);
        if (obstacle(*rectangle, sides, faces_[beyond], height).isEmpty()) add_box(sides, rest.volume());
      }
    }
  }
  /// A rectangle that ends a little earlier.
  Eigen::AlignedBox2d inside(Eigen::AlignedBox2d sides) const {
    sides.min().array() += inside_;
    sides.max().array() -= inside_;
    return sides;
  }

  /// Bounds of the triangles that are in the box over some of a face, to a height on the region's side of it.
  Eigen::AlignedBox2d obstacle(const Rectangle& rectangle, const Eigen::AlignedBox2d& sides,
                               const FlatFace& face, double height) {
    if (!tree_) index_triangles();
    const core::Vec3 &x = rectangle.x, &y = rectangle.y, &z = face.normal;
    const core::Vec3 half(0.5 * sides.sizes().x(), 0.5 * sides.sizes().y(), 0.5 * height - inside_);
    const Eigen::Vector2d middle = sides.center();
    const core::Vec3 centre = middle.x() * x + middle.y() * y + (face.offset - 0.5 * height) * z;
    const core::Vec3 reach = half.x() * x.cwiseAbs() + half.y() * y.cwiseAbs() + half.z() * z.cwiseAbs();
    contact::Box around;
    around.add(centre - reach);
    around.add(centre + reach);
    Eigen::AlignedBox2d bounds;
    for (const std::uint32_t number : tree_->touching(around)) {
      const BoundaryTriangle placed = boundary_.triangle(number);
      BoundaryTriangle triangle = placed;
      for (core::Vec3& corner : triangle) {
        const core::Vec3 from_centre = corner - centre;
        corner = {x.dot(from_centre), y.dot(from_centre), z.dot(from_centre)};
      }
      if (apart(triangle, half)) continue;
      for (const core::Vec3& corner : placed) bounds.extend(in_plane(x, y, corner));
    }
    return bounds;
  }

  void index_triangles() {
    std::vector<contact::Box> boxes(boundary_.size());
    for (std::uint32_t i = 0; i < boundary_.size(); ++i)
      for (const core::Vec3& corner : boundary_.triangle(i)) boxes[i].add(corner);
    tree_.emplace(std::move(boxes));
  }

  const Boundary& boundary_;
  const std::vector<FlatFace>& faces_;
  std::vector<std::optional<Rectangle>> rectangles_;
  double inside_;  ///< mm
  std::optional<contact::BoxTree> tree_;
};

}  // namespace

ThinGaps find_thin_gaps(const Boundary& boundary, const std::vector<FlatFace>& faces) {
  return GapSearch(boundary, faces).find();
}

}  // namespace scintray::scene
