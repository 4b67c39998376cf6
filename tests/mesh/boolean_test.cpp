#include "scintray/mesh/boolean.hpp"

#include <doctest/doctest.h>

#include <set>

#include "scintray/mesh/diagnosis.hpp"
#include "scintray/mesh/shapes/primitives.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::mesh;

TEST_CASE("A boolean difference has its exact volume, and every triangle the index of its origin") {
  const TriMesh block = make_box({0, 0, 0}, {4, 4, 4}), rod = make_box({1, 1, -1}, {2, 3, 5});
  const auto cut = boolean(block, rod, BooleanOperation::subtract, 1e-7);
  REQUIRE(cut);
  CHECK(diagnose(cut->mesh).sound());
  CHECK(cut->mesh.volume() == doctest::Approx(64.0 - 8.0).epsilon(1e-12));
  double bore = 0.0;
  std::set<std::uint32_t> sides;
  for (std::size_t t = 0; t < cut->origin.size(); ++t) {
    const TriangleOrigin& origin = cut->origin[t];
    const TriMesh& parent = origin.of_second ? rod : block;
    const Vec3 own = cut->mesh.area_vector(t).normalized();
    const Vec3 from = parent.area_vector(origin.triangle).normalized();
    CHECK(own.dot(from) == doctest::Approx(origin.of_second ? -1.0 : 1.0));
    if (!origin.of_second) continue;
    bore += cut->mesh.area_vector(t).norm();
    sides.insert(parent.group[origin.triangle]);
  }
  CHECK(bore == doctest::Approx(4.0 * 6.0).epsilon(1e-12));
  CHECK(sides.size() == 4);
}

TEST_CASE("Flush faces cut cleanly, a cut through and through leaves two bodies, all of it nothing") {
  const TriMesh block = make_box({0, 0, 0}, {4, 4, 4});
  const auto notch = boolean(block, make_box({0, 1, 2}, {4, 3, 4}), BooleanOperation::subtract, 1e-7);
  REQUIRE(notch);
  CHECK(notch->mesh.volume() == doctest::Approx(48.0));
  const auto halves = boolean(block, make_box({-1, -1, 1}, {5, 5, 2}), BooleanOperation::subtract, 1e-7);
  REQUIRE(halves);
  CHECK(diagnose(halves->mesh).bodies == 2);
  CHECK(halves->mesh.volume() == doctest::Approx(48.0));
  const auto nothing = boolean(block, make_box({-1, -1, -1}, {5, 5, 5}), BooleanOperation::subtract, 1e-7);
  REQUIRE(nothing);
  CHECK(nothing->mesh.triangles.empty());
}

TEST_CASE("What is no solid is refused") {
  TriMesh open = make_box({0, 0, 0}, {1, 1, 1});
  open.triangles.pop_back();
  open.group.pop_back();
  const TriMesh whole = make_box({0.5, 0.5, 0.5}, {2, 2, 2});
  CHECK_FALSE(boolean(open, whole, BooleanOperation::unite, 1e-7));
  CHECK_FALSE(boolean(whole, open, BooleanOperation::subtract, 1e-7));
  // Two boxes that share an edge: the union would have an edge of four triangles.
  CHECK_FALSE(
      boolean(make_box({0, 0, 0}, {1, 1, 1}), make_box({1, 1, 0}, {2, 2, 1}), BooleanOperation::unite, 1e-7));
}
