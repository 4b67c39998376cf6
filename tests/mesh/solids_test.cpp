#include "scintray/mesh/shapes/solids.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "scintray/core/error.hpp"
#include "scintray/mesh/boolean.hpp"
#include "scintray/mesh/diagnosis.hpp"
#include "scintray/mesh/export/triangle_files.hpp"
#include "scintray/mesh/face_selection.hpp"
#include "scintray/mesh/import/import.hpp"
#include "scintray/mesh/shapes/primitives.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::mesh;

namespace {

void check_sound(const TriMesh& mesh, double volume_mm3) {
  const MeshDiagnosis diagnosis = diagnose(mesh);
  CHECK(diagnosis.sound());
  CHECK(diagnosis.volume_mm3 == doctest::Approx(volume_mm3).epsilon(1e-9));
}

/// Area of the polygon with corners on a circle.
double polygon_area(double radius, int corners, double extent = kTwoPi) {
  return 0.5 * corners * radius * radius * std::sin(extent / corners);
}

}  // namespace

TEST_CASE("A turned outline has the volume of its polygons, whole or in part, on the axis or off it") {
  const std::vector<Eigen::Vector2d> rod{{0, 0}, {2, 0}, {2, 5}, {0, 5}},
      pipe{{1, 0}, {2, 0}, {2, 5}, {1, 5}};
  check_sound(revolved(rod, {0.0, kTwoPi, 36}), 5.0 * polygon_area(2, 36));
  check_sound(revolved(pipe, {0.3, kTwoPi, 36}), 5.0 * (polygon_area(2, 36) - polygon_area(1, 36)));
  check_sound(revolved(rod, {0.3, 1.5, 7}), 5.0 * polygon_area(2, 7, 1.5));
  check_sound(revolved(pipe, {-1.0, 4.0, 9}), 5.0 * (polygon_area(2, 9, 4.0) - polygon_area(1, 9, 4.0)));
  const std::vector<Eigen::Vector2d> cone{{0, 0}, {3, 0}, {0, 4}};
  check_sound(revolved(cone, {0.0, kTwoPi, 12}), 4.0 / 3.0 * polygon_area(3, 12));
  // The other way round the outline: outwards stays outwards.
  check_sound(revolved({cone.rbegin(), cone.rend()}, {0.0, kTwoPi, 12}), 4.0 / 3.0 * polygon_area(3, 12));
}

TEST_CASE("Bodies between outlines: a frustum, and a wedge whose one end is an edge") {
  const auto square = [](double half, double z) {
    return std::vector<Vec3>{{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}};
  };
  check_sound(lofted({square(3, 0), square(1, 6)}), 6.0 / 3.0 * (36.0 + 4.0 + 12.0));
  check_sound(lofted({square(1, 0), square(1, 1), square(2, 1.5), square(2, 3)}),
              4.0 + 0.5 / 3.0 * (4 + 16 + 8) + 24.0);
  check_sound(lofted({square(1, 0), {{-1, 0, 2}, {1, 0, 2}, {1, 0, 2}, {-1, 0, 2}}}), 4.0);
  CHECK_THROWS_AS(lofted({square(1, 0)}), InputError);
  CHECK_THROWS_AS(lofted({square(1, 0), {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}}), InputError);
}

TEST_CASE("Impossible outlines and bodies of too many triangles are refused") {
  CHECK_THROWS_AS(revolved({{0, 0}, {1, 0}}, {}), InputError);
  CHECK_THROWS_AS(revolved({{-1, 0}, {1, 0}, {1, 1}}, {}), InputError);
  CHECK_THROWS_AS(revolved({{0, 0}, {1, 0}, {1, 1}}, {0.0, kTwoPi, 2}), InputError);
  CHECK_THROWS_WITH_AS(revolved({{0, 0}, {1, 0}, {1, 1}}, {0.0, kTwoPi, 10'000'000}),
                       doctest::Contains("4000000 triangles"), InputError);
}

TEST_CASE("An arc keeps its deviation and its angle") {
  for (const double deviation : {0.1, 0.001}) {
    const Tessellation tessellation{deviation, 10.0 * kDegree};
    const auto corners = arc({1.0, 2.0}, 5.0, 5.0, 0.0, 0.5 * kPi, tessellation);
    CHECK(corners.front().isApprox(Eigen::Vector2d(6.0, 2.0)));
    CHECK(corners.back().isApprox(Eigen::Vector2d(1.0, 7.0)));
    for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
      const Eigen::Vector2d middle = 0.5 * (corners[i] + corners[i + 1]) - Eigen::Vector2d(1.0, 2.0);
      CHECK(5.0 - middle.norm() <= deviation * (1.0 + 1e-9));
    }
    CHECK(corners.size() >= 10);
  }
}

TEST_CASE("Booleans of boxes that overlap, touch, lie in each other or apart") {
  const TriMesh a = make_box({0, 0, 0}, {2, 2, 2}), b = make_box({1, 1, 1}, {3, 3, 3});
  check_sound(combine(a, b, BooleanOperation::unite), 15.0);
  check_sound(combine(a, b, BooleanOperation::subtract), 7.0);
  check_sound(combine(a, b, BooleanOperation::intersect), 1.0);
  // Faces that lie on each other.
  check_sound(combine(a, make_box({2, 0, 0}, {3, 2, 2}), BooleanOperation::unite), 12.0);
  check_sound(combine(a, make_box({0.5, 0.5, -1}, {1.5, 1.5, 3}), BooleanOperation::subtract), 6.0);
  check_sound(combine(a, make_box({0, 0, 1}, {2, 2, 2}), BooleanOperation::subtract), 4.0);
  // A hollow, and two bodies side by side.
  const TriMesh hollow = combine(a, make_box({0.5, 0.5, 0.5}, {1.5, 1.5, 1.5}), BooleanOperation::subtract);
  check_sound(hollow, 7.0);
  CHECK(diagnose(hollow).bodies == 2);
  check_sound(combine(a, make_box({5, 5, 5}, {6, 6, 6}), BooleanOperation::unite), 9.0);
  CHECK(combine(a, make_box({5, 5, 5}, {6, 6, 6}), BooleanOperation::intersect).triangles.empty());
}

TEST_CASE("A boolean's faces keep the groups of the bodies that they come from") {
  const TriMesh a = make_box({0, 0, 0}, {2, 2, 2});
  TriMesh drill = make_cylinder(0.5, 5.0, 16);
  drill.groups = {"bore", "drill bottom", "drill top"};
  for (Vec3& v : drill.vertices) v += Vec3(1, 1, -1);
  const TriMesh drilled = combine(a, drill, BooleanOperation::subtract);
  check_sound(drilled, 8.0 - 2.0 * polygon_area(0.5, 16));
  FaceSelector bore;
  bore.group = "bore";
  const auto mask = select_triangles(drilled, bore);
  double area = 0.0;
  for (std::size_t t = 0; t < mask.size(); ++t)
    if (mask[t]) area += drilled.area_vector(t).norm();
  CHECK(area == doctest::Approx(2.0 * 16.0 * std::sin(kPi / 16)));
  FaceSelector top;
  top.group = "+z";
  double top_area = 0.0;
  const auto top_mask = select_triangles(drilled, top);
  for (std::size_t t = 0; t < top_mask.size(); ++t)
    if (top_mask[t]) top_area += drilled.area_vector(t).z();
  CHECK(top_area == doctest::Approx(4.0 - polygon_area(0.5, 16)));
}

TEST_CASE("Booleans of open or inverted meshes are refused") {
  const TriMesh a = make_box({0, 0, 0}, {2, 2, 2});
  TriMesh open = a, inverted = a;
  open.triangles.pop_back();
  open.group.pop_back();
  reverse_orientation(inverted);
  CHECK_THROWS_WITH_AS(static_cast<void>(combine(a, open, BooleanOperation::unite)),
                       doctest::Contains("the second body"), InputError);
  CHECK_THROWS_AS(static_cast<void>(combine(inverted, a, BooleanOperation::unite)), InputError);
}

TEST_CASE("write_ply keeps double precision") {
  const auto path = test::scratch_folder("mesh_ply") / "box.ply";
  const TriMesh box = make_box({0.1, 0.2, 0.3}, {1.0 / 3.0, 2.0 / 3.0, 1000.1});
  write_ply(path, box);
  const TriMesh read = import_mesh(path, 1.0).mesh;
  REQUIRE(read.vertices.size() == 8);
  for (std::size_t v = 0; v < 8; ++v) CHECK(read.vertices[v] == box.vertices[v]);
  CHECK(read.triangles == box.triangles);
}
