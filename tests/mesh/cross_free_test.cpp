#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "scintray/mesh/detail/cgal_checks.hpp"
#include "scintray/mesh/repair/detail/passes.hpp"
#include "scintray/mesh/repair/repair.hpp"
#include "scintray/mesh/shapes/primitives.hpp"

using namespace scintray::core;
using namespace scintray::mesh;

namespace {

constexpr double kRadius = 5.0, kLength = 10.0;

/// A cylinder along z, as programs export it: its ends are fans around their middle, of as many triangles as
/// the wall has sides. The ends have groups of their own.
TriMesh cylinder_of_fans(std::uint32_t sides, std::uint32_t rings) {
  TriMesh mesh;
  for (std::uint32_t i = 0; i <= rings; ++i)
    for (std::uint32_t j = 0; j < sides; ++j) {
      const double angle = 2.0 * std::numbers::pi * j / sides;
      mesh.vertices.emplace_back(kRadius * std::cos(angle), kRadius * std::sin(angle), kLength * i / rings);
    }
  const auto bottom = static_cast<std::uint32_t>(mesh.vertices.size()), top = bottom + 1;
  mesh.vertices.emplace_back(0.0, 0.0, 0.0);
  mesh.vertices.emplace_back(0.0, 0.0, kLength);
  mesh.groups = {"wall", "ends"};
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t group) {
    mesh.triangles.push_back({a, b, c});
    mesh.group.push_back(group);
  };
  for (std::uint32_t j = 0; j < sides; ++j) {
    const std::uint32_t next = (j + 1) % sides, last = rings * sides;
    for (std::uint32_t i = 0; i < rings; ++i) {
      add(i * sides + j, i * sides + next, (i + 1) * sides + next, 0);
      add(i * sides + j, (i + 1) * sides + next, (i + 1) * sides + j, 0);
    }
    add(bottom, next, j, 1);
    add(top, last + j, last + next, 1);
  }
  return mesh;
}

double polygon_volume(std::uint32_t sides) {
  return 0.5 * sides * kRadius * kRadius * std::sin(2.0 * std::numbers::pi / sides) * kLength;
}

}  // namespace

TEST_CASE("Crossings beside a vertex of a thousand edges cost a few covers, and leave the rest as it is") {
  constexpr std::uint32_t kSides = 1000, kRings = 3;
  TriMesh mesh = cylinder_of_fans(kSides, kRings);
  // Corners of an end moved over their neighbours: their triangles cross those of a dozen others.
  for (const std::uint32_t j : {10u, 300u, 777u}) {
    Vec3& corner = mesh.vertices[kRings * kSides + j];
    corner = mesh.vertices[kRings * kSides + j + 6] + Vec3(0.0, 0.0, -0.2);
  }
  const auto crossings = self_intersections(mesh);
  REQUIRE(crossings.size() >= 30);
  const CrossFree mended = without_crossings(mesh, crossings);
  CHECK(mended.remaining == 0);
  CHECK(mended.left_out.count == 3);
  CHECK(mended.covers_tried <= 12);
  CHECK(mended.farthest_mm < 0.21);
  CHECK(diagnose(mended.mesh).sound());
  CHECK(mended.mesh.triangles.size() == mesh.triangles.size() - 6);
  CHECK(mended.mesh.volume() == doctest::Approx(polygon_volume(kSides)).epsilon(1e-6));
  double ends = 0.0;
  for (std::size_t t = 0; t < mended.mesh.triangles.size(); ++t)
    if (mended.mesh.group[t] == 1) ends += mended.mesh.area_vector(t).norm();
  CHECK(ends == doctest::Approx(2.0 * polygon_volume(kSides) / kLength).epsilon(1e-4));
}

TEST_CASE(
    "A pole of hundreds of edges that lies in the wall beside it goes back to the middle of its neighbours") {
  TriMesh mesh = cylinder_of_fans(400, 2);
  const std::uint32_t top = 401 + 2 * 400;
  REQUIRE(mesh.vertices[top].isApprox(Vec3(0.0, 0.0, kLength)));
  mesh.vertices[top] = Vec3(kRadius + 1.0, 0.3, kLength - 1.0);
  const auto crossings = self_intersections(mesh);
  REQUIRE(!crossings.empty());
  const CrossFree mended = without_crossings(mesh, crossings);
  CHECK(mended.remaining == 0);
  CHECK(mended.left_out.count == 1);
  CHECK(diagnose(mended.mesh).sound());
  CHECK(mended.mesh.volume() == doctest::Approx(polygon_volume(400)).epsilon(1e-6));
}

TEST_CASE("Repair states how far the vertices were that crossings cost, and which bodies stay as they are") {
  TriMesh mesh = cylinder_of_fans(60, 6);
  mesh.vertices[3 * 60 + 7] = Vec3(-kRadius - 0.5, 0.0, 4.0);  // of the wall, through the opposite one
  const RepairedMesh repaired = repair_mesh(mesh);
  CHECK(repaired.after.sound());
  REQUIRE(repaired.steps.size() == 2);
  CHECK(repaired.steps[1].where.count == 1);
  CHECK(repaired.steps[1].what.find("left out where triangles crossed") != std::string::npos);

  // A tube through its own wall is no local defect.
  TriMesh crossed = cylinder_of_fans(100, 40);
  for (Vec3& v : crossed.vertices) {
    const double angle = 2.43 * std::numbers::pi * v.z() / kLength;  // more than once around
    v = Vec3((9.0 + v.x()) * std::cos(angle), (9.0 + v.x()) * std::sin(angle), v.y());
  }
  const RepairedMesh refused = repair_mesh(crossed);
  CHECK(!refused.after.sound());
  CHECK(refused.mesh.triangles.size() == crossed.triangles.size());
  CHECK(refused.refused.size() == 1);
}
