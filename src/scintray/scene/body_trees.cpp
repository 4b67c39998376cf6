#include <functional>

#include "scintray/scene/exact_bodies.hpp"

namespace scintray::scene {

namespace {

using Box = Eigen::AlignedBox3d;

/// Builder of a tree of boxes that are cut in halves.
class TreeBuilder {
 public:
  /// @param leaves  numbers of what has the boxes, which are put in the order of the tree
  TreeBuilder(std::vector<BodyNode>& nodes, std::vector<std::uint32_t>& leaves,
              std::function<Box(std::uint32_t)> box_of)
      : nodes_(nodes), leaves_(leaves), box_of_(std::move(box_of)) {}

  void add(std::uint32_t begin, std::uint32_t end) {
    constexpr std::uint32_t kMostInLeaf = 3;
    const std::size_t at = nodes_.size();
    Box box;
    for (std::uint32_t i = begin; i < end; ++i) box.extend(box_of_(leaves_[i]));
    nodes_.push_back({box.min(), box.max(), begin, end, 0});
    if (end - begin <= kMostInLeaf) return;
    int axis = 0;
    box.sizes().maxCoeff(&axis);
    const std::uint32_t middle = begin + (end - begin) / 2;
    const auto from = leaves_.begin();
    std::nth_element(from + begin, from + middle, from + end, [&](std::uint32_t a, std::uint32_t b) {
      const Box box_a = box_of_(a), box_b = box_of_(b);
      const double place_a = box_a.min()[axis] + box_a.max()[axis];
      const double place_b = box_b.min()[axis] + box_b.max()[axis];
      return place_a != place_b ? place_a < place_b : a < b;
    });
    nodes_[at].begin = nodes_[at].end = 0;
    add(begin, middle);
    nodes_[at].second = static_cast<std::uint32_t>(nodes_.size());
    add(middle, end);
  }

 private:
  std::vector<BodyNode>& nodes_;
  std::vector<std::uint32_t>& leaves_;
  std::function<Box(std::uint32_t)> box_of_;
};

}  // namespace

void ExactBodies::build_tree() {
  constexpr std::size_t kFew = 6;
  const auto first = static_cast<std::uint32_t>(held);
  if (bodies.size() <= first + kFew) return;
  for (std::uint32_t i = first; i < bodies.size(); ++i) in_leaves.push_back(i);
  TreeBuilder(nodes, in_leaves, [&](std::uint32_t i) {
    return Box(bodies[i].low.vec(), bodies[i].high.vec());
  }).add(0, static_cast<std::uint32_t>(in_leaves.size()));
}

void ExactBodies::build_face_tree(ExactBody& body) {
  constexpr std::uint32_t kFew = 8;
  if (body.faces_end - body.faces_begin <= kFew) return;
  const auto begin = static_cast<std::uint32_t>(faces_in_leaves.size());
  for (std::uint32_t i = body.faces_begin; i < body.faces_end; ++i) faces_in_leaves.push_back(i);
  body.root = static_cast<std::uint32_t>(face_nodes.size());
  TreeBuilder(face_nodes, faces_in_leaves, [&](std::uint32_t i) {
    return Box(faces[i].low.vec(), faces[i].high.vec());
  }).add(begin, static_cast<std::uint32_t>(faces_in_leaves.size()));
}

}  // namespace scintray::scene
