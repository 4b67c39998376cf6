#include <doctest/doctest.h>

#include <algorithm>

#include "scintray/core/error.hpp"
#include "scintray/core/sampling.hpp"
#include "scintray/mesh/shapes/polygon.hpp"
#include "scintray/mesh/shapes/primitives.hpp"
#include "scintray/mesh/shapes/shapes.hpp"
#include "scintray/scene/accelerator.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::mesh;
using namespace scintray::scene_file;
using namespace scintray::scene;

namespace {

std::vector<BoundaryTriangle> triangles_of(const TriMesh& mesh, bool inward = false) {
  std::vector<BoundaryTriangle> triangles;
  for (const auto& [a, b, c] : mesh.triangles) {
    triangles.push_back({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
    if (inward) std::swap(triangles.back()[1], triangles.back()[2]);
  }
  return triangles;
}

std::vector<std::uint32_t> numbered(std::size_t n) {
  std::vector<std::uint32_t> labels(n);
  for (std::uint32_t i = 0; i < n; ++i) labels[i] = i;
  return labels;
}

/// Distance to the wall of a box from inside, in closed form.
double box_exit(const Vec3& p, const Vec3& d, const Vec3& low, const Vec3& high) {
  double nearest = HUGE_VAL;
  for (int axis = 0; axis < 3; ++axis)
    if (d[axis] != 0.0) nearest = std::min(nearest, ((d[axis] > 0.0 ? high : low)[axis] - p[axis]) / d[axis]);
  return nearest;
}

/// A prism over a polygon in the plane, counterclockwise, from z = 0.
TriMesh prism_over(const std::vector<std::array<double, 2>>& polygon, double height) {
  const auto n = static_cast<std::uint32_t>(polygon.size());
  TriMesh mesh;
  for (const double z : {0.0, height})
    for (const auto& [x, y] : polygon) mesh.vertices.push_back({x, y, z});
  bool simple = true;
  for (const auto& [a, b, c] :
       triangulate_polygon({mesh.vertices.begin(), mesh.vertices.begin() + n}, simple)) {
    mesh.triangles.push_back({b, a, c});
    mesh.triangles.push_back({n + a, n + b, n + c});
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t next = (i + 1) % n;
    mesh.triangles.push_back({i, next, n + next});
    mesh.triangles.push_back({i, n + next, n + i});
  }
  mesh.groups = {"all"};
  mesh.group.assign(mesh.triangles.size(), 0);
  return mesh;
}

}  // namespace

TEST_CASE("Planes and Embree find the closed-form exit of a box, also from its own walls and edges") {
  const Vec3 low(-1, -1, -10), high(1, 1, 10);
  const TriMesh box = make_box(low, high);
  const auto triangles = triangles_of(box);
  const auto labels = numbered(triangles.size());
  const Accelerator planes(triangles, labels, true, AcceleratorKind::planes);
  const Accelerator embree(triangles, labels, true, AcceleratorKind::embree);
  CHECK(planes.uses_planes());
  CHECK(planes.plane_count() == 6);
  CHECK_FALSE(embree.uses_planes());
  Vec3 p = Vec3::Zero();
  for (std::uint64_t i = 0; i < 200'000; ++i) {
    Rng rng(1, StreamKind::other, i);
    Vec3 d = sample_isotropic(rng);
    if (i % 3 == 0) {  // from an edge, or from a corner
      p = Vec3(1, i % 2 ? 1.0 : rng.uniform(), i % 6 ? 10.0 * rng.uniform() : 10.0);
      d = Vec3(-std::abs(d.x()), -std::abs(d.y()), -std::abs(d.z()));
    }
    if (i % 1000 == 1) d = Vec3(d.x(), d.y(), 1e-9).normalized();  // almost along a wall
    const double expected = std::max(0.0, box_exit(p, d, low, high));
    const Exit a = planes.find_exit(p, d), b = embree.find_exit(p, d);
    REQUIRE(a.triangle != kNoTriangle);
    REQUIRE(b.triangle != kNoTriangle);
    REQUIRE(std::abs(a.distance_mm - expected) < 1e-9);
    REQUIRE(std::abs(b.distance_mm - expected) < 2e-4 * (1.0 + expected));  // an edge may go to either wall
    p += a.distance_mm * d;
  }
}

TEST_CASE("No ray leaves a closed body without a hit, however fine or slender its triangles") {
  // Photons bounce diffusely inside; each position must stay within rounding of the body.
  struct Body {
    const char* name;
    TriMesh mesh;
  };
  const std::vector<Body> bodies{{"fine box", subdivide_faces(make_box({-1, -1, -10}, {1, 1, 10}), 16)},
                                 {"sphere", make_sphere(5.0, 12)},
                                 {"cylinder of slivers", make_cylinder(2.0, 40.0, 200)},
                                 {"thin plate", make_box({-50, -50, 0}, {50, 50, 1e-3})}};
  for (const Body& body : bodies) {
    CAPTURE(body.name);
    const auto triangles = triangles_of(body.mesh);
    const Accelerator accelerator(triangles, numbered(triangles.size()), true, AcceleratorKind::embree);
    Eigen::AlignedBox3d bounds;
    for (const Vec3& v : body.mesh.vertices) bounds.extend(v);
    const double tolerance = 1e-4 * bounds.diagonal().norm();
    Vec3 p = bounds.center(), d = Vec3(0.3, 0.4, 0.5).normalized();
    std::uint64_t resolved = 0;
    constexpr std::uint64_t kSteps = 300'000;
    Rng rng(2, StreamKind::other, 0);
    for (std::uint64_t i = 0; i < kSteps; ++i) {
      const Exit exit = accelerator.find_exit(p, d);
      REQUIRE(exit.triangle != kNoTriangle);
      resolved += exit.resolved;
      p += exit.distance_mm * d;
      REQUIRE(bounds.exteriorDistance(p) < tolerance);
      d = sample_lambertian(-accelerator.normal(exit.triangle), rng);
    }
    MESSAGE(body.name << ": " << resolved << " of " << kSteps << " queries settled by the exact search");
    CHECK(resolved < kSteps / 20);
  }
}

TEST_CASE("From the ambient region rays hit the outside of a body or go to infinity") {
  const auto triangles = triangles_of(make_box({-1, -1, -1}, {1, 1, 1}), true);
  const Accelerator ambient(triangles, numbered(triangles.size()), false, AcceleratorKind::automatic);
  CHECK_FALSE(ambient.uses_planes());
  CHECK(ambient.find_exit({0, 0, 5}, {0, 0, 1}).triangle == kNoTriangle);
  const Exit hit = ambient.find_exit({0.2, 0.3, 5}, {0, 0, -1});
  REQUIRE(hit.triangle != kNoTriangle);
  CHECK(hit.distance_mm == doctest::Approx(4.0).epsilon(1e-12));
  CHECK(ambient.normal(hit.triangle).z() == doctest::Approx(-1.0));
  // From its surface outwards: not hit again.
  CHECK(ambient.find_exit({0.2, 0.3, 1}, Vec3(0.6, 0, 0.8)).triangle == kNoTriangle);
}

TEST_CASE("Planes are refused where the region is not convex, with a hint") {
  TriMesh two = joined(make_box({0, 0, 0}, {1, 1, 1}), make_box({3, 0, 0}, {4, 1, 1}));
  const auto triangles = triangles_of(two);
  const auto labels = numbered(triangles.size());
  CHECK_FALSE(Accelerator(triangles, labels, true, AcceleratorKind::automatic).uses_planes());
  CHECK_THROWS_WITH_AS(Accelerator(triangles, labels, true, AcceleratorKind::planes),
                       doctest::Contains("use accelerator = \"auto\""), InputError);
}

TEST_CASE("The planes of a box along the axes are in the order of the axes; other bodies are none") {
  const auto boundary_of = [](const TriMesh& mesh, double turned = 0.0) {
    auto triangles = triangles_of(mesh);
    const Eigen::AngleAxisd turn(turned, Vec3(1, 2, 3).normalized());
    for (BoundaryTriangle& triangle : triangles)
      for (Vec3& corner : triangle) corner = turn * corner;
    const std::vector<std::uint32_t> labels(triangles.size(), 0);
    return make_boundary(triangles, labels, true, AcceleratorKind::planes, {});
  };
  const Boundary box = boundary_of(make_box({-1, -2, -3}, {4, 5, 6}));
  REQUIRE(box.is_box);
  REQUIRE(box.planes.size() == 6);
  CHECK(box.opposite_planes == 6);
  const std::array<double, 6> offsets = {4, 1, 5, 2, 6, 3};
  for (int i = 0; i < 6; ++i) {
    CAPTURE(i);
    const BoundingPlane& plane = box.planes[static_cast<std::size_t>(i)];
    CHECK(plane.normal.vec() == Vec3((i % 2 == 0 ? 1.0 : -1.0) * Vec3::Unit(i / 2)));
    CHECK(plane.offset == offsets[static_cast<std::size_t>(i)]);
    CHECK(box.triangle_planes[plane.first].normal == plane.normal);
  }
  CHECK_FALSE(boundary_of(make_box({-1, -2, -3}, {4, 5, 6}), 0.1).is_box);
  CHECK_FALSE(boundary_of(make_cylinder(2.0, 5.0, 6)).is_box);
  CHECK_FALSE(boundary_of(prism_over({{0, 0}, {2, 0}, {2, 1}, {0, 3}}, 1.0)).is_box);  // one face is inclined
  // A box with a corner cut off has seven planes.
  CHECK_FALSE(boundary_of(prism_over({{0, 0}, {2, 0}, {2, 1}, {1, 2}, {0, 2}}, 1.0)).is_box);
}

TEST_CASE("A point is inside a body or not, by planes and by rays alike") {
  const auto triangles = triangles_of(make_cylinder(2.0, 5.0, 24));
  const std::vector<std::uint32_t> labels(triangles.size(), 0);
  const Accelerator planes(triangles, labels, true, AcceleratorKind::automatic);
  const Accelerator embree(triangles, labels, true, AcceleratorKind::embree);
  REQUIRE(planes.uses_planes());
  std::uint64_t inside = 0;
  for (std::uint64_t i = 0; i < 5'000; ++i) {
    Rng rng(4, StreamKind::other, i);
    const double x = rng.uniform(), y = rng.uniform(), z = rng.uniform();
    const Vec3 p(6.0 * x - 3.0, 6.0 * y - 3.0, 8.0 * z - 1.0);
    CHECK(planes.contains(p) == embree.contains(p));
    inside += planes.contains(p);
  }
  CHECK(inside > 500);
}

TEST_CASE("Flat faces of many triangles are searched as few, and rays hit what they hit before") {
#ifdef SCINTRAY_SANITIZED
  constexpr std::uint32_t kFlatRays = 20'000;
#else
  constexpr std::uint32_t kFlatRays = 60'000;
#endif
  struct Body {
    std::string name;
    TriMesh mesh;
    std::size_t searched;  ///< triangles; 0: all
  };
  const TriMesh bracket = prism_over({{{0, 0}, {5, 0}, {5, 1}, {1, 1}, {1, 4}, {0, 4}}}, 3.0);
  const TriMesh frame = make_tube({4.0, 2.0, 3.0, 4});
  const std::vector<Body> bodies{{"box", subdivide_faces(make_box({-1, -1, -10}, {1, 1, 10}), 16), 12},
                                 {"bracket", subdivide_faces(bracket, 4), 2 * 4 + 6 * 2},
                                 {"hexagon", subdivide_faces(make_prism(6, 2.0, 5.0), 5), 2 * 4 + 6 * 2},
                                 // The ends have a hole: they keep their triangles.
                                 {"frame", subdivide_faces(frame, 3), 8 * 2 + 2 * 8 * 9},
                                 {"as it is", bracket, 0}};
  for (const Body& body : bodies)
    for (const bool outside : {false, true}) {
      CAPTURE(body.name);
      CAPTURE(outside);
      const auto triangles = triangles_of(body.mesh, outside);
      const std::vector<std::uint32_t> one(triangles.size(), 0);
      const Accelerator few(triangles, one, !outside, AcceleratorKind::embree);
      const Accelerator all(triangles, numbered(triangles.size()), !outside, AcceleratorKind::embree);
      CHECK(all.boundary().merged.empty());
      CHECK(few.boundary().merged.corners.size() == 3 * body.searched);
      Rng rng(9, StreamKind::other, 0);
      std::uint64_t hits = 0, unlike = 0;
      for (std::uint32_t i = 0; i < kFlatRays; ++i) {
        const BoundaryTriangle& t = triangles[i % triangles.size()];
        const Vec3 from = (t[0] + t[1] + t[2]) / 3.0 + 0.1 * rng.uniform() * (t[1] - t[0]);
        const Vec3 along =
            sample_lambertian(-all.normal(i % static_cast<std::uint32_t>(triangles.size())), rng);
        const Exit a = few.find_exit(from, along), b = all.find_exit(from, along);
        REQUIRE((a.triangle == kNoTriangle) == (b.triangle == kNoTriangle));
        if (a.triangle == kNoTriangle) continue;
        ++hits;
        REQUIRE(std::abs(a.distance_mm - b.distance_mm) < 2e-4 * (1.0 + b.distance_mm));
        const bool alike = std::abs(a.distance_mm - b.distance_mm) < 1e-9 &&
                           (few.normal(a.triangle) - all.normal(b.triangle)).norm() < 1e-9;
        unlike += alike ? 0 : 1;  // next to an edge: either wall
      }
      if (!outside) CHECK(hits == kFlatRays);
      CHECK(unlike < 10);
    }
}
