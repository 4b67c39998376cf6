#include "scintray/contact/box_tree.hpp"

#include <algorithm>

#include <doctest/doctest.h>

#include "scintray/core/rng.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::contact;
using contact::Box;
using contact::BoxTree;

namespace {

/// Corners on a coarse grid, so that many boxes only just touch and some have no volume.
std::vector<Box> grid_boxes(std::uint64_t stream, std::size_t count) {
  Rng rng(7, StreamKind::other, stream, 0);
  const auto at = [&] { return std::floor(20.0 * rng.uniform()); };
  std::vector<Box> boxes(count);
  for (Box& box : boxes) {
    box.low = Vec3(at(), at(), at());
    box.high = box.low + Vec3(std::floor(4.0 * rng.uniform()), std::floor(4.0 * rng.uniform()),
                              std::floor(4.0 * rng.uniform()));
  }
  return boxes;
}

}  // namespace

TEST_CASE("The boxes that touch another are those that a search through all finds, in their order") {
  for (const std::size_t count : {1, 2, 3, 500}) {
    const std::vector<Box> boxes = grid_boxes(1, count);
    const BoxTree tree(boxes);
    for (const Box& query : grid_boxes(2, 200)) {
      std::vector<std::uint32_t> expected;
      for (std::uint32_t i = 0; i < boxes.size(); ++i)
        if (boxes[i].overlaps(query)) expected.push_back(i);
      CHECK(tree.touching(query) == expected);
    }
    CHECK(tree.box(0).low == boxes[0].low);
  }
}

TEST_CASE("A ray passes through the boxes that hold its points, and through none behind or beside it") {
  const std::vector<Box> boxes = grid_boxes(3, 300);
  const BoxTree tree(boxes);
  Rng rng(7, StreamKind::other, 4, 0);
  for (int k = 0; k < 100; ++k) {
    const Vec3 origin = 20.0 * Vec3(rng.uniform(), rng.uniform(), rng.uniform());
    const Vec3 direction = Vec3(rng.uniform(), rng.uniform(), rng.uniform()) - Vec3::Constant(0.5);
    const std::vector<std::uint32_t> found = tree.on_ray(origin, direction);
    CHECK(std::is_sorted(found.begin(), found.end()));
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
      const Eigen::Array3d a = (boxes[i].low - origin).array() / direction.array();
      const Eigen::Array3d b = (boxes[i].high - origin).array() / direction.array();
      const double enters = std::max(0.0, a.min(b).maxCoeff()), leaves = a.max(b).minCoeff();
      const bool is_found = std::binary_search(found.begin(), found.end(), i);
      if (enters < leaves - 1e-9) CHECK(is_found);
      if (enters > leaves + 1e-9) CHECK_FALSE(is_found);
    }
  }
}

TEST_CASE("An empty box touches nothing, and neither does an empty tree") {
  const Box all = Box{Vec3::Constant(-1e6), Vec3::Constant(1e6)};
  CHECK(BoxTree().touching(all).empty());
  CHECK(BoxTree(std::vector<Box>{}).touching(all).empty());
  CHECK(BoxTree(std::vector<Box>{Box(), all, Box()}).touching(all) == std::vector<std::uint32_t>{1});
  CHECK(BoxTree(std::vector<Box>{all}).touching(Box()).empty());
  CHECK(BoxTree().on_ray(Vec3::Zero(), Vec3::UnitX()).empty());
}
