// Round faces recognized in triangles, of which the shapes are known.
#include "scintray/mesh/recognize.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "scintray/core/rng.hpp"
#include "scintray/mesh/export/triangle_files.hpp"
#include "scintray/mesh/import/import.hpp"
#include "scintray/mesh/shapes/primitives.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::mesh;

namespace {

/// The triangles alone, turned and moved: what a file of triangles states.
TriMesh as_triangles(const TriMesh& shape) {
  Eigen::Affine3d motion = Eigen::Affine3d::Identity();
  motion.rotate(Eigen::AngleAxisd(0.7, Vec3(1.0, -2.0, 0.5).normalized()));
  motion.translation() = Vec3(3.0, -20.0, 7.0);
  TriMesh result = transformed(shape, motion);
  result.supports.clear();
  result.support.clear();
  return result;
}

double radius_of(const TriMesh& mesh, const RecognizedFace& face) {
  return std::sqrt(mesh.supports[face.support].radius2);
}

std::size_t triangles_with_support(const TriMesh& mesh) {
  return mesh.triangles.size() -
         static_cast<std::size_t>(std::count(mesh.support.begin(), mesh.support.end(), kNoSupport));
}

constexpr double kTolerance = 1e-6;  // mm

}  // namespace

TEST_CASE("The wall of a cylinder of triangles is recognized, and its ends stay flat") {
  for (const int sides : {12, 13, 72, 512}) {
    CAPTURE(sides);
    TriMesh mesh = as_triangles(make_cylinder(1.5, 20.0, sides));
    const std::vector<RecognizedFace> found = recognize_round_faces(mesh, kTolerance);
    REQUIRE(found.size() == 1);
    CHECK(std::string(mesh.supports[0].name()) == "cylinder");
    CHECK(radius_of(mesh, found[0]) == doctest::Approx(1.5).epsilon(1e-9));
    CHECK(found[0].corner_distance_mm < 1e-9);
    CHECK(found[0].triangles == 2 * static_cast<std::size_t>(sides));
    CHECK(triangles_with_support(mesh) == found[0].triangles);
  }
}

TEST_CASE("Spheres and cones of triangles are recognized") {
  TriMesh ball = as_triangles(make_sphere(2.0, 6));
  std::vector<RecognizedFace> found = recognize_round_faces(ball, kTolerance);
  REQUIRE(found.size() == 1);
  CHECK(ball.supports[0].is_sphere());
  CHECK(radius_of(ball, found[0]) == doctest::Approx(2.0).epsilon(1e-9));
  CHECK(triangles_with_support(ball) == ball.triangles.size());

  TriMesh frustum = as_triangles(make_cone(2.0, 0.5, 3.0, 48));
  found = recognize_round_faces(frustum, kTolerance);
  REQUIRE(found.size() == 1);
  const SupportSurface& wall = frustum.supports[0];
  CHECK(std::string(wall.name()) == "cone");
  CHECK(std::sqrt(-wall.axial) == doctest::Approx(0.5).epsilon(1e-9));  // 1.5 mm over 3 mm
  CHECK(triangles_with_support(frustum) == 2 * 48);
  CHECK(describe(frustum, found[0]).find("cone of half-angle 26.5651 deg") == 0);

  TriMesh tip = as_triangles(make_cone(2.0, 0.0, 3.0, 48));
  found = recognize_round_faces(tip, kTolerance);
  REQUIRE(found.size() == 1);
  CHECK(std::sqrt(-tip.supports[0].axial) == doctest::Approx(2.0 / 3.0).epsilon(1e-9));
}

TEST_CASE("Walls that are short for their radius are not taken for the sphere through their two rims") {
  for (const double height : {0.1, 1.0, 5.0}) {
    CAPTURE(height);
    TriMesh disc = as_triangles(make_cylinder(4.0, height, 72));
    const std::vector<RecognizedFace> found = recognize_round_faces(disc, kTolerance);
    REQUIRE(found.size() == 1);
    CHECK(std::string(disc.supports[0].name()) == "cylinder");
    CHECK(radius_of(disc, found[0]) == doctest::Approx(4.0).epsilon(1e-9));

    TriMesh frustum = as_triangles(make_cone(4.0, 3.0, height, 72));
    REQUIRE(recognize_round_faces(frustum, kTolerance).size() == 1);
    CHECK(std::string(frustum.supports[0].name()) == "cone");
  }
}

TEST_CASE("Faces that are not round, or not exactly, are not recognized") {
  TriMesh box = make_box({0.0, 0.0, 0.0}, {1.0, 2.0, 3.0});
  CHECK(recognize_round_faces(box, kTolerance).empty());
  CHECK(box.support.empty());

  TriMesh hexagon = as_triangles(make_cylinder(1.5, 20.0, 6));  // its sides meet at 60 degrees
  CHECK(recognize_round_faces(hexagon, kTolerance).empty());

  Eigen::Affine3d stretch = Eigen::Affine3d::Identity();
  stretch.linear().diagonal() = Vec3(1.0, 1.3, 0.8);
  TriMesh ellipsoid = transformed(make_sphere(2.0, 6), stretch);
  ellipsoid.supports.clear();
  ellipsoid.support.clear();
  CHECK(triangles_with_support([&] {
          recognize_round_faces(ellipsoid, kTolerance);
          ellipsoid.support.resize(ellipsoid.triangles.size(), kNoSupport);
          return ellipsoid;
        }()) == 0);

  TriMesh rough = as_triangles(make_cylinder(1.5, 20.0, 72));
  Rng rng(3, StreamKind::photon, 1);
  for (Vec3& vertex : rough.vertices) vertex += 1e-3 * (Vec3(rng.uniform(), rng.uniform(), rng.uniform()));
  CHECK(recognize_round_faces(rough, kTolerance).empty());
  TriMesh within = rough;
  const std::vector<RecognizedFace> found = recognize_round_faces(within, 1e-3);
  REQUIRE(found.size() == 1);
  CHECK(found[0].corner_distance_mm > 1e-5);
  CHECK(found[0].corner_distance_mm <= 1e-3);
  CHECK(radius_of(within, found[0]) == doctest::Approx(1.5).epsilon(1e-3));
}

TEST_CASE("Flat walls tangent to round ones are distinguished: a bar with half-round sides") {
  // Two half cylinders of radius 1 mm, 4 mm apart, and the planes between them.
  constexpr int kSides = 24;
  constexpr double kHeight = 5.0;
  std::vector<std::array<double, 2>> outline;
  for (int side = 0; side <= kSides; ++side) {
    const double angle = -0.5 * kPi + kPi * side / kSides;
    outline.push_back({2.0 + std::cos(angle), std::sin(angle)});
  }
  for (int side = 0; side <= kSides; ++side) {
    const double angle = 0.5 * kPi + kPi * side / kSides;
    outline.push_back({-2.0 + std::cos(angle), std::sin(angle)});
  }
  TriMesh bar;
  const auto n = static_cast<std::uint32_t>(outline.size());
  for (const double z : {0.0, kHeight})
    for (const auto& [x, y] : outline) bar.vertices.push_back({x, y, z});
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t next = (i + 1) % n;
    bar.triangles.push_back({i, next, n + next});
    bar.triangles.push_back({i, n + next, n + i});
    if (i > 0 && next > 0) {
      bar.triangles.push_back({0, next, i});
      bar.triangles.push_back({n, n + i, n + next});
    }
  }
  bar.group.assign(bar.triangles.size(), 0);
  bar.groups = {"default"};
  TriMesh mesh = as_triangles(bar);
  const std::vector<RecognizedFace> found = recognize_round_faces(mesh, kTolerance);
  REQUIRE(found.size() == 2);
  for (const RecognizedFace& face : found) {
    CHECK(radius_of(mesh, face) == doctest::Approx(1.0).epsilon(1e-9));
    CHECK(face.triangles == 2 * kSides);
  }
}

TEST_CASE("A cylinder in single precision, as STL has it, is recognized within the contact tolerance") {
  const auto path = test::scratch_folder("recognized") / "rod.stl";
  TriMesh shape = make_cylinder(1.5, 20.0, 64);
  translate(shape, {100.0, 200.0, 50.0});
  write_stl(path, shape);
  TriMesh mesh = import_mesh(path, 1.0).mesh;
  const std::vector<RecognizedFace> found = recognize_round_faces(mesh, 1e-4);
  REQUIRE(found.size() == 1);
  CHECK(radius_of(mesh, found[0]) == doctest::Approx(1.5).epsilon(1e-5));
  CHECK(found[0].corner_distance_mm < 4e-5);
}
