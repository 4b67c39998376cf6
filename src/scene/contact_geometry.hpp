#pragma once
/// Geometry that resolving contacts needs: boxes, a tree of boxes, and a part with both.

#include <array>
#include <cstdint>
#include <vector>

#include "scintray/core/vec.hpp"
#include "scintray/scene/contacts.hpp"

namespace scintray::contact {

using Vec2 = Eigen::Vector2d;
using Triangle = std::array<std::uint32_t, 3>;

/// An axis-aligned box; empty until a point is added.
struct Box {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = Vec3::Constant(-std::numeric_limits<double>::infinity());

  void add(const Vec3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  void add(const Box& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
  Box grown(double by) const {
    Box box = *this;
    box.low.array() -= by;
    box.high.array() += by;
    return box;
  }
  bool meets(const Box& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
  bool contains(const Box& other) const {
    return (low.array() <= other.low.array()).all() && (other.high.array() <= high.array()).all();
  }
  /// Does the ray origin + t direction, t >= 0, meet the box? `inverse` is 1 / direction by component.
  bool meets_ray(const Vec3& origin, const Vec3& inverse) const {
    const Eigen::Array3d a = (low - origin).array() * inverse.array();
    const Eigen::Array3d b = (high - origin).array() * inverse.array();
    return std::max(0.0, a.min(b).maxCoeff()) <= a.max(b).minCoeff();
  }
};

/// A binary tree over boxes, split at the median of the longest axis. Visits come in a fixed order.
class BoxTree {
 public:
  BoxTree() = default;
  explicit BoxTree(std::vector<Box> boxes);

  /// Calls visit(index) for every box that meets `query`.
  template <typename Visit>
  void visit(const Box& query, Visit&& visit) const {
    walk([&](const Box& box) { return box.meets(query); }, visit);
  }
  /// Calls visit(index) for every box that the ray meets; no component of `direction` may be zero.
  template <typename Visit>
  void visit_ray(const Vec3& origin, const Vec3& direction, Visit&& visit) const {
    const Vec3 inverse = direction.cwiseInverse();
    walk([&](const Box& box) { return box.meets_ray(origin, inverse); }, visit);
  }
  const Box& box(std::uint32_t index) const { return boxes_[index]; }

 private:
  struct Node {
    Box box;
    std::uint32_t begin = 0, end = 0;  ///< range of order_
    std::uint32_t right = 0;           ///< second child (the first follows its parent); 0 in a leaf
  };
  void build(std::uint32_t begin, std::uint32_t end);

  template <typename Meets, typename Visit>
  void walk(Meets&& meets, Visit&& visit) const {
    std::array<std::uint32_t, 64> stack;  // the median split halves: depth is at most 32
    std::size_t size = 0;
    if (!nodes_.empty()) stack[size++] = 0;
    while (size > 0) {
      const std::uint32_t at = stack[--size];
      const Node& node = nodes_[at];
      if (!meets(node.box)) continue;
      if (node.right != 0) {
        stack[size++] = node.right;
        stack[size++] = at + 1;
        continue;
      }
      for (std::uint32_t i = node.begin; i < node.end; ++i)
        if (meets(boxes_[order_[i]])) visit(order_[i]);
    }
  }

  std::vector<Box> boxes_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

/// Rotation into axes along the largest faces of all parts, in which boxes fit arrays of crystals
/// closely however the assembly is turned. Identity for an upright assembly.
Eigen::Matrix3d natural_axes(const std::vector<PlacedPart>& parts);

/// Where a point lies with respect to a body.
enum class Side { inside, outside, on_surface };

/// A part with what the queries need. Boxes are in the axes given on construction.
class Body {
 public:
  Body(const PlacedPart& part, const Eigen::Matrix3d& axes);

  /// Recomputes all that depends on the vertices, after they moved.
  void update();

  Box box_of(std::uint32_t triangle) const;
  Box box_of(const Vec3& a, const Vec3& b) const;
  const Vec3& corner(std::uint32_t triangle, int k) const { return vertices[triangles[triangle][k]]; }
  /// Normal times area, mm2.
  Vec3 area_vector(std::uint32_t triangle) const;

  /// Side of `point`; on_surface when it is within `margin_mm` of a triangle.
  Side side_of(const Vec3& point, double margin_mm) const;
  /// A point well inside: the middle of the longest chord among those that start perpendicularly at
  /// the largest triangles.
  Vec3 interior_point() const;

  std::vector<Vec3> vertices;  ///< equal positions are one vertex
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> face;
  std::vector<Vec3> normal;  ///< unit; zero for a triangle without area
  double area = 0.0;         ///< mm2
  double volume = 0.0;       ///< mm3
  Box box;
  BoxTree tree;                       ///< of the triangles
  std::vector<std::uint32_t> shells;  ///< a vertex of each connected piece of the surface

 private:
  void find_shells();
  bool encloses(const Vec3& point) const;
  Eigen::Matrix3d axes_;
};

/// Distance from a point to a triangle, mm.
double distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace scintray::contact
