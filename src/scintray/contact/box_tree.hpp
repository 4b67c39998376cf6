#pragma once
/// Boxes, and a search among many of them.

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "scintray/core/vec.hpp"

namespace scintray::contact {

/// An axis-aligned box; empty until a point is added.
struct Box {
  core::Vec3 low = core::Vec3::Constant(std::numeric_limits<double>::infinity());
  core::Vec3 high = core::Vec3::Constant(-std::numeric_limits<double>::infinity());

  void add(const core::Vec3& p) {
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
  bool empty() const { return (low.array() > high.array()).any(); }
  bool overlaps(const Box& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
  bool contains(const Box& other) const {
    return (low.array() <= other.low.array()).all() && (other.high.array() <= high.array()).all();
  }
};

/// Boxes in CGAL's tree of axis-aligned boxes. Copies share the tree, which never changes.
class BoxTree {
 public:
  BoxTree() = default;
  explicit BoxTree(std::vector<Box> boxes);

  /// Indices of the boxes that have a point in common with `query`, ascending.
  [[nodiscard]] std::vector<std::uint32_t> touching(const Box& query) const;
  /// Indices of the boxes that the ray origin + t direction, t >= 0, crosses, ascending. Boxes that it only
  /// grazes may or may not be included.
  [[nodiscard]] std::vector<std::uint32_t> on_ray(const core::Vec3& origin,
                                                  const core::Vec3& direction) const;

  const Box& box(std::uint32_t index) const { return boxes_[index]; }

 private:
  struct Tree;
  std::vector<Box> boxes_;
  std::shared_ptr<const Tree> tree_;
};

}  // namespace scintray::contact
