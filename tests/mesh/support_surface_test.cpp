// Surfaces that round faces approximate: what a body encloses beyond its facets, and motions.
#include <doctest/doctest.h>

#include "scintray/mesh/shapes/primitives.hpp"
#include "scintray/mesh/smooth_faces.hpp"
#include "scintray/mesh/support_surface.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::mesh;

namespace {

struct Sums {
  double area = 0.0, volume = 0.0;
};

std::array<Vec3, 3> corners_of(const TriMesh& mesh, std::size_t t) {
  const auto& [a, b, c] = mesh.triangles[t];
  return {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
}

/// Area and volume of the walls of a mesh, with the exact patches.
Sums exact_sums(const TriMesh& mesh) {
  Sums sums{mesh.area(), mesh.volume()};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.support_of(t) == kNoSupport) continue;
    const PatchExcess excess = patch_excess(mesh.supports[mesh.support_of(t)], corners_of(mesh, t));
    sums.area += excess.area_mm2;
    sums.volume += excess.volume_mm3;
  }
  return sums;
}

/// A frustum of `sides` between circles of radius r at z = 0 and R at z = h, without its ends.
TriMesh frustum_wall(double r, double big_r, double h, int sides) {
  TriMesh mesh = make_cylinder(1.0, h, sides);
  keep_triangles(mesh, [&] {
    std::vector<char> wall(mesh.triangles.size(), 0);
    for (std::size_t t = 0; t < wall.size(); ++t) wall[t] = mesh.support_of(t) != kNoSupport;
    return wall;
  }());
  for (Vec3& v : mesh.vertices) {
    const double radius = v.z() == 0.0 ? r : big_r;
    v.x() *= radius;
    v.y() *= radius;
  }
  mesh.supports = {SupportSurface::cone(Vec3::Zero(), Vec3::UnitZ(), r, big_r, h)};
  return mesh;
}

}  // namespace

TEST_CASE("Patches of a sphere, a cylinder and a cone have the exact area and volume for any facets") {
  for (const int subdivisions : {1, 3, 8}) {
    const Sums ball = exact_sums(make_sphere(2.5, subdivisions));
    CHECK(ball.area == doctest::Approx(4.0 * kPi * 6.25).epsilon(1e-12));
    CHECK(ball.volume == doctest::Approx(4.0 / 3.0 * kPi * 15.625).epsilon(1e-12));
  }
  for (const int sides : {6, 12, 72}) {
    CAPTURE(sides);
    const TriMesh rod = make_cylinder(1.5, 20.0, sides);
    Sums sums = exact_sums(rod);
    CHECK(sums.volume == doctest::Approx(kPi * 2.25 * 20.0).epsilon(1e-12));
    double ends = 0.0;
    for (int i = 0; i < sides; ++i)
      ends += 2.0 * segment_area(rod.supports[0], Vec3::UnitZ(), rod.vertices[static_cast<std::size_t>(i)],
                                 rod.vertices[static_cast<std::size_t>((i + 1) % sides)]);
    CHECK(sums.area + ends == doctest::Approx(2.0 * kPi * 1.5 * (20.0 + 1.5)).epsilon(1e-12));
    const Sums cone = exact_sums(frustum_wall(1.0, 3.0, 4.0, sides));
    CHECK(cone.area == doctest::Approx(kPi * 4.0 * std::sqrt(4.0 + 16.0)).epsilon(sides < 12 ? 1e-9 : 1e-12));
  }
}

TEST_CASE("A support surface is where its facets' corners are, and moves with them") {
  Eigen::Affine3d motion = Eigen::Affine3d::Identity();
  motion.translate(Vec3(10.0, -4.0, 2.0))
      .rotate(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()))
      .scale(2.5);
  for (const TriMesh& mesh : {make_sphere(2.0, 4), make_cylinder(1.0, 3.0, 16),
                              frustum_wall(1.0, 0.2, 2.0, 16), frustum_wall(0.5, 4.0, 1.0, 16)}) {
    const TriMesh moved = transformed(mesh, motion);
    REQUIRE(moved.supports.size() == 1);
    for (std::size_t t = 0; t < moved.triangles.size(); ++t) {
      if (moved.support_of(t) == kNoSupport) continue;
      for (const Vec3& corner : corners_of(moved, t)) {
        CHECK(std::abs(moved.supports[0].distance(corner)) < 1e-13 * 20.0);
        const Vec3 off = corner + 1e-4 * moved.supports[0].normal(corner);
        CHECK(moved.supports[0].distance(off) == doctest::Approx(1e-4).epsilon(1e-6));
        CHECK(moved.supports[0].value(off) > 0.0);
        CHECK((off + moved.supports[0].correction(off) - corner).norm() < 1e-7);
      }
      CHECK(moved.supports[0].normal(corners_of(moved, t)[0]).dot(moved.area_vector(t)) > 0.0);
    }
  }
  Eigen::Affine3d stretch = Eigen::Affine3d::Identity();
  stretch.scale(Vec3(1.0, 2.0, 1.0));
  CHECK(transformed(make_sphere(1.0, 2), stretch).supports.empty());
  CHECK(transformed(make_sphere(1.0, 2), stretch).support.empty());
  CHECK(subdivide_faces(make_sphere(1.0, 2), 2).supports.empty());
}

TEST_CASE("Meshes in one keep their support surfaces apart, and a translation moves them") {
  TriMesh both =
      joined(make_box({-9, -9, -9}, {-8, -8, -8}), joined(make_sphere(1.0, 2), make_cylinder(2.0, 1.0, 8)));
  REQUIRE(both.supports.size() == 2);
  translate(both, Vec3(1.0, 2.0, 3.0));
  std::array<std::size_t, 3> count{};
  for (std::size_t t = 0; t < both.triangles.size(); ++t) {
    const std::uint32_t support = both.support_of(t);
    ++count[support == kNoSupport ? 2 : support];
    if (support == kNoSupport) continue;
    for (const Vec3& corner : corners_of(both, t))
      CHECK(std::abs(both.supports[support].distance(corner)) < 1e-12);
  }
  CHECK(count == std::array<std::size_t, 3>{80, 16, 12 + 12});
}

TEST_CASE("Two support surfaces are one where they agree at the corners and in their normals") {
  const SupportSurface one = SupportSurface::cylinder({0, 0, 0}, Vec3::UnitZ(), 2.0);
  const SupportSurface turned = SupportSurface::cylinder({0, 0, 7}, -Vec3::UnitZ(), 2.0);
  const std::array<Vec3, 3> points{Vec3(2, 0, 0), Vec3(0, 2, 0), Vec3(0, 2, 5)};
  CHECK(one.agrees_with(turned, points, 1e-6));
  CHECK_FALSE(one.agrees_with(SupportSurface::cylinder({0, 0, 0}, Vec3::UnitZ(), 2.01), points, 1e-3));
  CHECK_FALSE(one.agrees_with(SupportSurface::sphere({0, 0, 0}, 2.0), points, 1e-3));
  // Tangent from outside.
  CHECK_FALSE(one.agrees_with(SupportSurface::cylinder({4, 0, 0}, Vec3::UnitZ(), 2.0),
                              {Vec3(2, 0, 0), Vec3(2, 0, 1), Vec3(2, 0, 2)}, 1e-3));
}

TEST_CASE("Facets deviate from a circle by the sagitta and half of their angle") {
  const TriMesh rod = make_cylinder(1.5, 20.0, 72);
  const FacetDeviation deviation = facet_deviation(rod.supports[0], corners_of(rod, 0));
  CHECK(deviation.distance_mm == doctest::Approx(1.5 * (1.0 - std::cos(kPi / 72))).epsilon(1e-9));
  CHECK(deviation.angle_rad == doctest::Approx(kPi / 72).epsilon(1e-9));
}

TEST_CASE("Facets without a known surface are measured by the angles between them, edges of a body are not") {
  TriMesh rod = make_cylinder(1.5, 20.0, 72);
  rod.supports.clear();
  rod.support.clear();
  const std::vector<std::uint32_t> one_face(rod.triangles.size(), 0);
  const FacetDeviation round = smooth_face_deviations(rod, one_face, 1).front();
  CHECK(round.angle_rad == doctest::Approx(kPi / 72).epsilon(1e-6));
  CHECK(round.distance_mm == doctest::Approx(1.5 * (1.0 - std::cos(kPi / 72))).epsilon(1e-2));
  for (const TriMesh& sharp : {make_box({0, 0, 0}, {1, 2, 3}), make_cylinder(1.0, 1.0, 72)}) {
    const std::vector<std::uint32_t> faces(sharp.triangles.size(), 0);
    CHECK(smooth_face_deviations(sharp, faces, 1).front().angle_rad == 0.0);
  }
}
