#include "scintray/mesh/face_selection.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>

#include "scintray/core/error.hpp"
#include "scintray/mesh/shapes/primitives.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::mesh;

namespace {

std::set<std::string> groups_where(const TriMesh& mesh, const FaceSelector& selector) {
  std::set<std::string> groups;
  const auto mask = select_triangles(mesh, selector);
  for (std::size_t t = 0; t < mask.size(); ++t) {
    if (mask[t]) groups.insert(mesh.groups[mesh.group[t]]);
  }
  return groups;
}

std::ptrdiff_t count(const TriMesh& mesh, const FaceSelector& selector) {
  const auto mask = select_triangles(mesh, selector);
  return std::count(mask.begin(), mask.end(), 1);
}

const TriMesh kBox = make_box({0, 0, 0}, {1, 2, 3});

}  // namespace

TEST_CASE("No condition selects every triangle, of an empty mesh none") {
  CHECK(count(kBox, {}) == 12);
  FaceSelector nearest;
  nearest.nearest = Vec3(0, 0, 0);
  CHECK(select_triangles({}, nearest).empty());
}

TEST_CASE("A normal selects faces within its tolerance") {
  FaceSelector selector;
  selector.normal = Vec3(0, 0, -2);
  CHECK(groups_where(kBox, selector) == std::set<std::string>{"-z"});
  // 36 segments: facet normals every 10 degrees, at 5, 15, ... degrees.
  const TriMesh cylinder = make_cylinder(1.0, 1.0, 36);
  selector.normal = Vec3(std::cos(5 * kDegree), std::sin(5 * kDegree), 0.0);
  CHECK(count(cylinder, selector) == 2);
  selector.normal_tolerance_rad = 10.1 * kDegree;
  CHECK(count(cylinder, selector) == 6);
  selector.normal = Vec3(0, 0, 0);
  CHECK_THROWS_AS(select_triangles(kBox, selector), InputError);
}

TEST_CASE("A box selects triangles wholly inside, its border included") {
  FaceSelector selector;
  selector.box = Eigen::AlignedBox3d(Vec3(0, 0, 3), Vec3(1, 2, 3));
  CHECK(groups_where(kBox, selector) == std::set<std::string>{"+z"});
  selector.box = Eigen::AlignedBox3d(Vec3(-1, -1, 3.001), Vec3(9, 9, 9));
  CHECK(count(kBox, selector) == 0);
  selector.box = Eigen::AlignedBox3d(Vec3(-9, -9, -9), Vec3(9, 9, 2.9));
  CHECK(groups_where(kBox, selector) == std::set<std::string>{"-z"});
}

TEST_CASE("A flat region stops at edges, and does not creep round a fine cylinder") {
  const TriMesh fine = subdivide_faces(kBox, 4);
  FaceSelector selector;
  selector.flat_region = Vec3(0.4, 0.7, 5.0);
  CHECK(groups_where(fine, selector) == std::set<std::string>{"+z"});
  CHECK(count(fine, selector) == 32);
  const TriMesh cylinder = make_cylinder(1.0, 1.0, 720);  // facets 0.5 degrees apart
  selector.flat_region = Vec3(2, 0.01, 0.5);
  CHECK(count(cylinder, selector) == 2);
  selector.flat_tolerance_rad = 1.1 * kDegree;  // the facet and two on either side, two triangles each
  CHECK(count(cylinder, selector) == 10);
}

TEST_CASE("A flat region does not jump to a coplanar face that is not connected") {
  const TriMesh two = joined(make_box({0, 0, 0}, {1, 1, 1}), make_box({2, 0, 0}, {3, 1, 1}));
  FaceSelector selector;
  selector.flat_region = Vec3(0.5, 0.5, 1.0);
  CHECK(count(two, selector) == 2);
}

TEST_CASE("Flat regions label the sides of a body") {
  const auto labels = flat_regions(subdivide_faces(kBox, 3), 0.1 * kDegree);
  CHECK(*std::max_element(labels.begin(), labels.end()) == 5);
  for (std::size_t t = 0; t < labels.size(); ++t) CHECK(labels[t] == t / 18);
  const auto round = flat_regions(make_cylinder(1.0, 1.0, 24), 0.1 * kDegree);
  CHECK(*std::max_element(round.begin(), round.end()) + 1 == 26);
  CHECK_THROWS_AS(flat_regions(kBox, -1.0), InputError);
}

TEST_CASE("Conditions combine, and nearest is one triangle") {
  FaceSelector selector;
  selector.normal = Vec3(1, 0, 0);
  selector.group = "+x";
  CHECK(count(kBox, selector) == 2);
  selector.group = "-x";
  CHECK(count(kBox, selector) == 0);
  FaceSelector nearest;
  nearest.nearest = Vec3(0.9, 1.9, -4.0);
  CHECK(count(kBox, nearest) == 1);
  CHECK(groups_where(kBox, nearest) == std::set<std::string>{"-z"});
}

TEST_CASE("A smooth region goes around a wall and over fillets, and stops at edges") {
  // 24 segments: facets 15 degrees apart; the ends at 90 degrees.
  const TriMesh cylinder = subdivide_faces(make_cylinder(1.0, 2.0, 24), 2);
  FaceSelector selector;
  selector.smooth_region = Vec3(5.0, 0.1, 1.0);
  CHECK(groups_where(cylinder, selector) == std::set<std::string>{"side"});
  CHECK(count(cylinder, selector) == 24 * 2 * 4);
  selector.edge_angle_rad = 14.0 * kDegree;
  CHECK(count(cylinder, selector) == 2 * 4);
  selector.edge_angle_rad = 91.0 * kDegree;
  CHECK(count(cylinder, selector) == static_cast<std::ptrdiff_t>(cylinder.triangles.size()));
  selector.edge_angle_rad = -1.0;
  CHECK_THROWS_AS(select_triangles(cylinder, selector), InputError);
}

TEST_CASE("A smooth region grows around a group, and combines with other conditions") {
  const TriMesh two =
      joined(make_cylinder(1.0, 2.0, 24),
             transformed(make_cylinder(1.0, 2.0, 24), Eigen::Affine3d(Eigen::Translation3d(5, 0, 0))));
  FaceSelector selector;
  selector.smooth_around = "side";
  CHECK(groups_where(two, selector) == std::set<std::string>{"side"});
  CHECK(count(two, selector) == 2 * 48);  // both bodies have the group
  selector.box = Eigen::AlignedBox3d(Vec3(3, -2, -1), Vec3(7, 2, 3));
  CHECK(count(two, selector) == 48);
  selector.smooth_around = "roof";
  CHECK(count(two, selector) == 0);
}

TEST_CASE("Smooth regions end at groups where that is asked for") {
  TriMesh box = subdivide_faces(kBox, 2);
  const std::vector<std::uint32_t> apart = smooth_regions(box, 30.0 * kDegree);
  CHECK(std::set(apart.begin(), apart.end()).size() == 6);
  const std::vector<std::uint32_t> all = smooth_regions(box, 90.5 * kDegree);
  CHECK(std::set(all.begin(), all.end()).size() == 1);
  const std::vector<std::uint32_t> by_group = smooth_regions(box, 90.5 * kDegree, true);
  CHECK(std::set(by_group.begin(), by_group.end()).size() == 6);
  std::vector<char> mask(box.triangles.size(), 0);
  mask[3] = 1;
  const std::vector<char> whole = whole_regions(mask, by_group);
  CHECK(std::count(whole.begin(), whole.end(), 1) == 8);
}
