#include "scintray/mesh/diagnosis.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "scintray/core/vec.hpp"
#include "scintray/mesh/detail/triangle_planes.hpp"
#include "scintray/mesh/shapes/primitives.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::mesh;

namespace {

TriMesh box() { return make_box({0, 0, 0}, {1, 1, 1}); }

void flip(TriMesh& mesh, std::size_t t) { std::swap(mesh.triangles[t][1], mesh.triangles[t][2]); }

/// The only problem reported.
Problem only_problem(const TriMesh& mesh) {
  const auto problems = mesh_problems(diagnose(mesh), "crystal");
  REQUIRE(problems.size() == 1);
  return problems.front();
}

void check_contains(const Problem& problem, const test::Fragments& fragments) {
  CAPTURE(problem.text());
  test::check_contains(problem.what, fragments);
  CHECK(problem.what.find("part \"crystal\"") != std::string::npos);
  CHECK_FALSE(problem.hint.empty());
}

}  // namespace

TEST_CASE("A box is sound, and its measures are right") {
  const auto diagnosis = diagnose(box());
  CHECK(diagnosis.sound());
  CHECK(diagnosis.bodies == 1);
  CHECK(diagnosis.volume_mm3 == doctest::Approx(1.0));
  CHECK(diagnosis.area_mm2 == doctest::Approx(6.0));
  CHECK(diagnosis.bounds.max() == Vec3(1, 1, 1));
  CHECK(mesh_problems(diagnosis, "crystal").empty());
}

TEST_CASE("A missing triangle leaves three open edges, with a place") {
  TriMesh mesh = box();
  mesh.triangles.pop_back();
  const auto diagnosis = diagnose(mesh);
  CHECK(diagnosis.open_edges.count == 3);
  CHECK_FALSE(diagnosis.closed());
  for (const Vec3& place : diagnosis.open_edges.examples) CHECK(place.z() == 1.0);
  check_contains(only_problem(mesh), "3 open edges");
}

TEST_CASE("A triangle turned round is found by its three edges and mended") {
  TriMesh mesh = box();
  flip(mesh, 7);
  CHECK(diagnose(mesh).flipped_edges.count == 3);
  CHECK_FALSE(diagnose(mesh).outward());
  check_contains(only_problem(mesh), {"3 edges", "opposite"});
  CHECK(orient_outwards(mesh));
  CHECK(mesh.triangles == box().triangles);
  CHECK_FALSE(orient_outwards(mesh));
}

TEST_CASE("A mesh inside out is found and turned") {
  TriMesh mesh = box();
  reverse_orientation(mesh);
  CHECK(diagnose(mesh).volume_mm3 == doctest::Approx(-1.0));
  CHECK(diagnose(mesh).inverted_bodies.count == 1);
  check_contains(only_problem(mesh), {"1 body", "inside out"});
  CHECK(orient_outwards(mesh));
  CHECK(diagnose(mesh).sound());
}

TEST_CASE("A hollow is oriented against its shell, and separate bodies each outwards") {
  const TriMesh outer = make_box({0, 0, 0}, {3, 3, 3});
  TriMesh hollow = make_box({1, 1, 1}, {2, 2, 2});
  CHECK(diagnose(joined(outer, hollow)).inverted_bodies.count == 1);
  reverse_orientation(hollow);
  TriMesh shell = joined(outer, hollow);
  CHECK(diagnose(shell).sound());
  CHECK(shell.volume() == doctest::Approx(26.0));
  CHECK_FALSE(orient_outwards(shell));

  TriMesh beside = make_box({5, 0, 0}, {6, 1, 1});
  reverse_orientation(beside);
  TriMesh two = joined(outer, beside);
  CHECK(diagnose(two).inverted_bodies.count == 1);
  CHECK(orient_outwards(two));
  CHECK(two.volume() == doctest::Approx(28.0));
  CHECK(diagnose(two).sound());
}

TEST_CASE("A fin makes a non-manifold edge, a doubled triangle three") {
  TriMesh fin = box();
  fin.vertices.emplace_back(0.5, 0.5, 2.0);
  fin.triangles.push_back({4, 5, 8});
  fin.group.push_back(0);
  CHECK(diagnose(fin).nonmanifold_edges.count == 1);
  CHECK(diagnose(fin).nonmanifold_edges.examples.front().isApprox(Vec3(0.5, 0.0, 1.0)));

  TriMesh doubled = box();
  doubled.triangles.push_back({doubled.triangles[3][1], doubled.triangles[3][2], doubled.triangles[3][0]});
  doubled.group.push_back(0);
  CHECK(diagnose(doubled).duplicate_triangles.count == 1);
  CHECK(diagnose(doubled).nonmanifold_edges.count == 3);
}

TEST_CASE("Crossing, overlapping and merely touching bodies are self-intersections; sharing none is not") {
  const auto crossings = [](const TriMesh& other) {
    return diagnose(joined(box(), other)).self_intersections.count;
  };
  CHECK(crossings(make_box({0.5, 0.5, 0.5}, {2, 2, 2})) > 0);
  CHECK(crossings(make_box({1, 0.25, 0.25}, {2, 0.75, 0.75})) > 0);
  CHECK(crossings(make_box({1.0 + 1e-12, 0, 0}, {2, 1, 1})) == 0);
  CHECK(diagnose(make_sphere(1.0, 6)).self_intersections.count == 0);
}

TEST_CASE("A fold onto a neighbour, and a spike through a neighbour of one vertex, are found") {
  TriMesh fold;
  fold.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.5, 0}};
  fold.triangles = {{0, 1, 2}, {1, 0, 3}};
  CHECK(diagnose(fold).self_intersections.count == 1);
  fold.vertices[3] = {0.2, -0.5, 0};
  CHECK(diagnose(fold).self_intersections.count == 0);

  TriMesh spike;
  spike.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 0.3, 1}, {0.4, 0.3, -1}};
  spike.triangles = {{0, 1, 2}, {0, 3, 4}};
  CHECK(diagnose(spike).self_intersections.count == 1);
  spike.vertices[4] = {0.4, 0.3, 2};
  CHECK(diagnose(spike).self_intersections.count == 0);
}

TEST_CASE("Triangles without area are counted, whether their vertices are equal or in line") {
  TriMesh mesh = box();
  mesh.vertices.emplace_back(0.5, 0.0, 0.0);
  mesh.triangles.push_back({0, 8, 1});
  mesh.triangles.push_back({2, 2, 3});
  mesh.group.insert(mesh.group.end(), 2, 0);
  CHECK(diagnose(mesh).degenerate_triangles.count == 2);
}

TEST_CASE("An index beyond the vertices is refused") {
  TriMesh mesh = box();
  mesh.triangles[0][0] = 8;
  CHECK_THROWS_AS(static_cast<void>(diagnose(mesh)), InputError);
  CHECK(mesh_problems(diagnose(TriMesh{}), "crystal").size() == 1);
}

TEST_CASE("Of the slivers of a fan, whose boxes all overlap, no pair needs the exact test for crossings") {
  constexpr std::uint32_t kCount = 400;
  TriMesh fan;  // two flat cones over one ring
  for (std::uint32_t j = 0; j < kCount; ++j) {
    const double angle = 2.0 * kPi * j / kCount;
    fan.vertices.emplace_back(10.0 * std::cos(angle), 10.0 * std::sin(angle), 0.0);
  }
  fan.vertices.emplace_back(0.0, 0.0, 1.0);
  fan.vertices.emplace_back(0.0, 0.0, -1.0);
  for (std::uint32_t j = 0; j < kCount; ++j) {
    fan.triangles.push_back({kCount, j, (j + 1) % kCount});
    fan.triangles.push_back({kCount + 1, (j + 1) % kCount, j});
  }
  const TrianglePlanes planes(fan);
  std::size_t pairs = 0, undecided = 0;
  for (std::uint32_t a = 0; a < fan.triangles.size(); ++a)
    for (std::uint32_t b = a + 1; b < fan.triangles.size(); ++b) {
      std::size_t common = 0;
      for (const std::uint32_t v : fan.triangles[a])
        common += std::count(fan.triangles[b].begin(), fan.triangles[b].end(), v) > 0 ? 1u : 0u;
      if (common == 2) continue;  // neighbours, which are few
      ++pairs;
      undecided += planes.clearly_apart(a, b) ? 0u : 1u;
    }
  CHECK(pairs > 300'000);
  CHECK(undecided == 0);
  CHECK(diagnose(fan).self_intersections.count == 0);
}
