#include "scintray/mesh/triangle_distance.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <utility>

using namespace scintray;
using namespace scintray::core;
using namespace scintray::mesh;

TEST_CASE("Distance to a triangle in each of its Voronoi regions") {
  const Vec3 a(0, 0, 0), b(4, 0, 0), c(0, 4, 0);
  const std::pair<Vec3, double> cases[] = {{{1, 1, 2}, 2.0},  {{-3, -4, 0}, 5.0}, {{7, -4, 0}, 5.0},
                                           {{-4, 7, 0}, 5.0}, {{2, -1, 0}, 1.0},  {{4, 4, 0}, std::sqrt(8.0)},
                                           {{-2, 1, 0}, 2.0}};
  for (const auto& [point, distance] : cases) {
    CHECK(distance_to_triangle(point, a, b, c) == doctest::Approx(distance));
    CHECK(distance_to_triangle(point, c, b, a) == doctest::Approx(distance));
  }
}

TEST_CASE("Triangles that share the corner nearest a point are at the same distance to the last bit") {
  const Vec3 corner(0.1, 0.7, -0.3), point(-1.0, -2.0, 0.5);
  const double distance = distance_to_triangle(point, corner, {1.3, 0.9, 0.1}, {0.4, 2.0, 0.2});
  CHECK(distance == (point - corner).norm());
  CHECK(distance == distance_to_triangle(point, {0.4, 2.0, 0.2}, corner, {1.7, 3.0, 0.0}));
}

TEST_CASE("Distance to a triangle without area is that to its longest side") {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(3, 0, 0);
  CHECK(distance_to_triangle({2, 1, 0}, a, b, c) == doctest::Approx(1.0));
  CHECK(distance_to_triangle({5, 0, 0}, a, b, c) == doctest::Approx(2.0));
  CHECK(distance_to_triangle({1, 2, 2}, a, a, a) == doctest::Approx(3.0));
}

TEST_CASE("Distance to a segment: beside it, beyond its ends, and of no length") {
  const Vec3 a(1, 0, 0), b(3, 0, 0);
  CHECK(distance_to_segment({1.5, 2, 0}, a, b) == doctest::Approx(2.0));
  CHECK(share_along_segment({1.5, 2, 0}, a, b) == doctest::Approx(0.25));
  CHECK(distance_to_segment({-2, 4, 0}, a, b) == doctest::Approx(5.0));
  CHECK(share_along_segment({-2, 4, 0}, a, b) == 0.0);
  CHECK(distance_to_segment({6, 0, 4}, a, b) == doctest::Approx(5.0));
  CHECK(share_along_segment({6, 0, 4}, a, b) == 1.0);
  CHECK(distance_to_segment({1, 2, 0}, a, a) == doctest::Approx(2.0));
  CHECK(share_along_segment({1, 2, 0}, a, a) == 0.0);
}
