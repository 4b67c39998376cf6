#include <algorithm>
#include <cmath>
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
  const auto box_of = [&](std::uint32_t i) { return Box(faces[i].low.vec(), faces[i].high.vec()); };
  const auto size_of = [](const Box& box) {
    const core::Vec3 side = box.sizes();
    return side.x() * side.y() + side.y() * side.z() + side.z() * side.x();
  };
  // Nearly every ray reaches the box of such a face, which would make every box of the tree as large. Where
  // there are more of them, as in a comb, the tree is faster.
  constexpr double kLarge = 0.05;
  constexpr std::uint32_t kMostLarge = 8;
  const double least = kLarge * size_of(Box(body.low.vec(), body.high.vec()));
  const auto is_large = [&](std::uint32_t i) { return size_of(box_of(i)) >= least; };
  const auto from = faces_in_leaves.begin() + begin;
  body.large_begin = body.large_end = begin;
  if (std::count_if(from, faces_in_leaves.end(), is_large) <= kMostLarge)
    body.large_end = static_cast<std::uint32_t>(std::stable_partition(from, faces_in_leaves.end(), is_large) -
                                                faces_in_leaves.begin());
  if (body.large_end == faces_in_leaves.size()) return;
  body.root = static_cast<std::uint32_t>(face_nodes.size());
  TreeBuilder(face_nodes, faces_in_leaves, box_of)
      .add(body.large_end, static_cast<std::uint32_t>(faces_in_leaves.size()));
}

namespace {

/// Division of a box into boxes that are about as long as wide.
TrimGrid divided(const Box& box, std::size_t wanted) {
  TrimGrid grid;
  grid.low = box.min();
  constexpr double kFiner = 0.9;
  for (double side = box.sizes().maxCoeff();; side *= kFiner) {
    std::size_t all = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const double count = std::ceil(box.sizes()[axis] / side);
      grid.count[static_cast<std::size_t>(axis)] = static_cast<std::uint32_t>(count);
      grid.per_mm[axis] = count / box.sizes()[axis];
      all *= static_cast<std::size_t>(count);
    }
    if (all >= wanted) return grid;
  }
}

}  // namespace

void ExactBodies::build_trim_grid(TrimmedFace& face) {
  constexpr std::uint32_t kFew = 8;
  constexpr std::size_t kBoxesPerTrim = 16, kMostBoxes = 32'768;
  const std::uint32_t many = face.trims_end - face.trims_begin;
  if (many <= kFew || face.cells_begin != face.cells_end) return;
  // Boxes overlap by more than rounding can move a point, and flat faces have some thickness.
  constexpr double kMargin = 1e-6;
  const core::Vec3 around = core::Vec3::Constant(kMargin * (face.high.vec() - face.low.vec()).norm());
  const Box box(face.low.vec() - around, face.high.vec() + around);
  TrimGrid grid = divided(box, std::min(kBoxesPerTrim * many, kMostBoxes));
  grid.first = static_cast<std::uint32_t>(trim_boxes.size());
  const core::Vec3 half = 0.5 * (1.0 + kMargin) * grid.per_mm.vec().cwiseInverse();
  for (std::uint32_t z = 0; z < grid.count[2]; ++z)
    for (std::uint32_t y = 0; y < grid.count[1]; ++y)
      for (std::uint32_t x = 0; x < grid.count[0]; ++x) {
        const core::Vec3 centre =
            box.min() + core::Vec3(x + 0.5, y + 0.5, z + 0.5).cwiseQuotient(grid.per_mm.vec());
        trim_boxes.push_back(trims_to_ask(face, centre, half));
      }
  face.grid = static_cast<std::uint32_t>(trim_grids.size());
  trim_grids.push_back(grid);
}

TrimBox ExactBodies::trims_to_ask(const TrimmedFace& face, const core::Vec3& centre, const core::Vec3& half) {
  constexpr double kSafe = 1.0 + 1e-6;
  TrimBox box;
  box.begin = static_cast<std::uint32_t>(asked_trims.size());
  for (std::uint32_t i = face.trims_begin; i < face.trims_end; ++i) {
    const Trim& trim = trims[i];
    const double value = value_of(trim, centre);
    const double change = trim.surface == kNoSurface
                              ? trim.normal.vec().cwiseAbs().dot(half)
                              : trim_surfaces[trim.surface].most_change(centre, half.norm());
    if (!(std::abs(value) > kSafe * change)) {
      asked_trims.push_back(i);
    } else if ((value > 0.0) != trim.above) {
      asked_trims.resize(box.begin);
      box.begin = kNoSurface;
      return box;
    }
  }
  box.end = static_cast<std::uint32_t>(asked_trims.size());
  return box;
}

}  // namespace scintray::scene
