#include "scintray/contact/box_tree.hpp"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <iterator>

namespace scintray::contact {

namespace {

/// Boxes are compared as they are, which needs no exact arithmetic.
using Kernel = CGAL::Simple_cartesian<double>;

Kernel::Point_3 point(const core::Vec3& p) { return {p.x(), p.y(), p.z()}; }

Kernel::Iso_cuboid_3 cuboid(const Box& box) { return {point(box.low), point(box.high)}; }

/// A box and its index, as CGAL's tree stores them (concept AABBPrimitive).
class BoxPrimitive {
 public:
  using Id = std::uint32_t;
  using Point = Kernel::Point_3;
  using Datum = Kernel::Iso_cuboid_3;
  using Datum_reference = const Datum&;
  using Point_reference = Point;

  BoxPrimitive() = default;
  BoxPrimitive(Id id, const Box& box) : id_(id), datum_(cuboid(box)) {}

  Id id() const { return id_; }
  Datum_reference datum() const { return datum_; }
  Point reference_point() const { return CGAL::midpoint((datum_.min)(), (datum_.max)()); }

 private:
  Id id_ = 0;
  Datum datum_;
};

using CgalTree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, BoxPrimitive>>;

}  // namespace

struct BoxTree::Tree {
  CgalTree tree;

  template <typename Query>
  std::vector<std::uint32_t> all(const Query& query) const {
    std::vector<std::uint32_t> found;
    tree.all_intersected_primitives(query, std::back_inserter(found));
    std::sort(found.begin(), found.end());
    return found;
  }
};

BoxTree::BoxTree(std::vector<Box> boxes) : boxes_(std::move(boxes)) {
  auto built = std::make_shared<Tree>();
  for (std::uint32_t i = 0; i < boxes_.size(); ++i)
    if (!boxes_[i].empty()) built->tree.insert(BoxPrimitive(i, boxes_[i]));
  built->tree.build();
  tree_ = std::move(built);
}

std::vector<std::uint32_t> BoxTree::touching(const Box& query) const {
  if (!tree_ || query.empty()) return {};
  return tree_->all(cuboid(query));
}

std::vector<std::uint32_t> BoxTree::on_ray(const core::Vec3& origin, const core::Vec3& direction) const {
  if (!tree_) return {};
  return tree_->all(
      Kernel::Ray_3(point(origin), Kernel::Vector_3(direction.x(), direction.y(), direction.z())));
}

}  // namespace scintray::contact
