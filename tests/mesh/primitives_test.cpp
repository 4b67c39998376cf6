#include "scintray/mesh/shapes/primitives.hpp"
#include "scintray/mesh/shapes/shapes.hpp"

#include <doctest/doctest.h>

#include <fstream>
#include <iterator>

#include "scintray/core/error.hpp"
#include "scintray/mesh/diagnosis.hpp"
#include "scintray/mesh/export/triangle_files.hpp"
#include "scintray/mesh/import/import.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::mesh;

namespace {

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

TEST_CASE("A box has the volume, area and sides of its corners") {
  const TriMesh box = make_box({-1.0, -2.0, 100.0}, {3.0, 5.0, 110.0});
  CHECK(box.volume() == doctest::Approx(4.0 * 7.0 * 10.0).epsilon(1e-12));
  CHECK(box.area() == doctest::Approx(2.0 * (4.0 * 7.0 + 7.0 * 10.0 + 4.0 * 10.0)).epsilon(1e-12));
  CHECK(diagnose(box).sound());
  for (std::size_t t = 0; t < 12; ++t) {
    const std::string& side = box.groups[box.group[t]];
    const int axis = side[1] - 'x';
    const Vec3 normal = box.area_vector(t).normalized();
    CHECK(normal[axis] == doctest::Approx(side[0] == '+' ? 1.0 : -1.0));
  }
  CHECK_THROWS_AS(make_box({0, 0, 0}, {1, 0, 1}), InputError);
  CHECK_THROWS_AS(make_box({0, 0, 0}, {1, std::nan(""), 1}), InputError);
}

TEST_CASE("A cylinder is the prism over a regular polygon") {
  for (const int n : {3, 4, 7, 360}) {
    CAPTURE(n);
    const double area = 0.5 * n * 2.0 * 2.0 * std::sin(kTwoPi / n);
    const double side = 2.0 * 2.0 * std::sin(kPi / n);
    const TriMesh cylinder = make_cylinder(2.0, 5.0, n);
    CHECK(cylinder.volume() == doctest::Approx(5.0 * area).epsilon(1e-12));
    CHECK(cylinder.area() == doctest::Approx(2.0 * area + 5.0 * n * side).epsilon(1e-12));
    CHECK(diagnose(cylinder).sound());
  }
  CHECK(make_cylinder(2.0, 5.0, 9, CylinderRadius::equal_area).volume() ==
        doctest::Approx(5.0 * kPi * 4.0).epsilon(1e-12));
  CHECK_THROWS_AS(make_cylinder(1.0, 1.0, 2), InputError);
  CHECK_THROWS_AS(make_cylinder(-1.0, 1.0, 8), InputError);
}

TEST_CASE("Ends of many corners have no triangle without area, however slim the body") {
  for (const int n : {200, 4096}) {
    CAPTURE(n);
    const double area = 0.5 * n * std::sin(kTwoPi / n);
    const TriMesh cylinder = make_cylinder(1.0, 20.0, n);
    CHECK(cylinder.volume() == doctest::Approx(20.0 * area).epsilon(1e-9));
    CHECK(diagnose(cylinder).sound());
    const TriMesh prism = make_prism(n, 1.0, 20.0);
    CHECK(prism.volume() == doctest::Approx(20.0 * area).epsilon(1e-9));
    CHECK(diagnose(prism).sound());
  }
  CHECK(diagnose(make_cylinder(0.5, 1000.0, 1000)).sound());
  CHECK(make_cylinder(1.0, 20.0, 48).vertices.size() == 96);  // few corners: none in the middle
}

TEST_CASE("A geodesic sphere converges to a sphere with the square of the subdivisions") {
  // Icosahedron with circumradius R: V = R^3 (40 + 8 sqrt 5)^(1/2) / 3 * ... checked through its edge
  // a = R / sin(2 pi / 5), V = 5 (3 + sqrt 5) / 12 a^3 (H. S. M. Coxeter, Regular Polytopes, table I).
  const double edge = 3.0 / std::sin(kTwoPi / 5.0);
  CHECK(make_sphere(3.0, 1).volume() ==
        doctest::Approx(5.0 * (3.0 + std::sqrt(5.0)) / 12.0 * std::pow(edge, 3)).epsilon(1e-12));
  const double exact = 4.0 / 3.0 * kPi * 27.0;
  const double deficit10 = 1.0 - make_sphere(3.0, 10).volume() / exact;
  const double deficit20 = 1.0 - make_sphere(3.0, 20).volume() / exact;
  CHECK(deficit10 > 0.0);
  CHECK(deficit10 / deficit20 == doctest::Approx(4.0).epsilon(0.02));
  const TriMesh sphere = make_sphere(3.0, 8);
  CHECK(sphere.triangles.size() == 20 * 64);
  CHECK(sphere.vertices.size() == 10 * 64 + 2);
  CHECK(diagnose(sphere).sound());
}

TEST_CASE("Cutting faces keeps the body, its groups and its shared edges") {
  const TriMesh box = make_box({0, 0, 0}, {1, 2, 3});
  const TriMesh fine = subdivide_faces(box, 5);
  CHECK(fine.triangles.size() == 12 * 25);
  CHECK(fine.volume() == doctest::Approx(6.0).epsilon(1e-12));
  CHECK(diagnose(fine).sound());
  CHECK(fine.group[3 * 25 + 24] == box.group[3]);
  CHECK_THROWS_AS(subdivide_faces(box, 0), InputError);
}

TEST_CASE("A mirrored mesh stays outward") {
  Eigen::Affine3d mirror = Eigen::Affine3d::Identity();
  mirror.translate(Vec3(5, 6, 7)).scale(Vec3(-2, 1, 1));
  const TriMesh moved = transformed(make_box({0, 0, 0}, {1, 1, 1}), mirror);
  CHECK(moved.volume() == doctest::Approx(2.0));
  CHECK(diagnose(moved).sound());
  mirror.scale(Vec3(0, 1, 1));
  CHECK_THROWS_AS(transformed(moved, mirror), InputError);
}

TEST_CASE("Joined meshes keep both bodies and merge groups by name") {
  const TriMesh both = joined(make_box({0, 0, 0}, {1, 1, 1}), make_box({2, 0, 0}, {3, 1, 1}));
  CHECK(both.groups.size() == 6);
  CHECK(diagnose(both).bodies == 2);
  CHECK(both.volume() == doctest::Approx(2.0));
}

TEST_CASE("geometry/crystal_2x2x20.stl is the box that write_stl makes, byte for byte") {
  const auto path = test::scratch_folder("mesh_stl") / "crystal_2x2x20.stl";
  const TriMesh crystal = make_box({-1, -1, 0}, {1, 1, 20});
  write_stl(path, crystal);
  CHECK(bytes_of(path).size() == 84 + 12 * 50);
  CHECK(bytes_of(path) == bytes_of(test::source_file("geometry/crystal_2x2x20.stl")));
  const MeshImport read = import_mesh(test::source_file("geometry/crystal_2x2x20.stl"), 1.0);
  CHECK(read.mesh.volume() == doctest::Approx(80.0).epsilon(1e-12));
  CHECK(read.notes.empty());
  for (std::size_t t = 0; t < 12; ++t) CHECK(read.mesh.area_vector(t).isApprox(crystal.area_vector(t), 1e-7));
  CHECK_THROWS_AS(write_stl(path.parent_path() / "no_such_folder" / "x.stl", crystal), SystemError);
}
