#include "scintray/mesh/repair/repair.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "scintray/mesh/shapes/primitives.hpp"
#include "scintray/mesh/weld.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::mesh;
using test::check_contains;
using test::contains;

namespace {

/// What was done, one kind a line: "1 holes filled".
std::string done(const RepairedMesh& repaired) {
  std::string text;
  for (const RepairStep& step : repaired.steps)
    text += std::to_string(step.where.count) + " " + step.what + "\n";
  return text;
}

TriMesh unit_box(const Vec3& low = Vec3::Zero()) { return make_box(low, low + Vec3::Ones()); }

TriMesh welded(TriMesh mesh) {
  weld_vertices(mesh, 1e-6);
  return mesh;
}

void drop(TriMesh& mesh, std::size_t triangle) {
  std::vector<char> wanted(mesh.triangles.size(), 1);
  wanted[triangle] = 0;
  keep_triangles(mesh, wanted);
}

}  // namespace

TEST_CASE("A sound mesh is returned as it is") {
  const TriMesh box = unit_box();
  const RepairedMesh repaired = repair_mesh(box);
  CHECK(repaired.steps.empty());
  CHECK(repaired.refused.empty());
  CHECK(repaired.mesh.vertices == box.vertices);
  CHECK(repaired.mesh.triangles == box.triangles);
  CHECK(repaired.mesh.group == box.group);
}

TEST_CASE("Holes are filled up to the stated size, with their neighbours' group") {
  TriMesh box = subdivide_faces(unit_box(), 4);
  drop(box, 100);
  const std::size_t full = box.triangles.size() + 1;
  const RepairedMesh repaired = repair_mesh(box);
  CHECK(done(repaired) == "1 holes filled\n");
  CHECK(repaired.after.sound());
  CHECK(repaired.mesh.triangles.size() == full);
  CHECK(repaired.after.volume_mm3 == doctest::Approx(1.0).epsilon(1e-12));
  CHECK(repaired.mesh.group.back() == box.group[99]);

  RepairSettings small;
  small.largest_hole_mm = 0.1;
  const RepairedMesh left = repair_mesh(box, small);
  CHECK(left.after.open_edges.count == 3);
  REQUIRE(left.refused.size() == 1);
  check_contains(left.refused[0], {"1 hole", "limit of 0.1 mm"});
}

TEST_CASE("A large hole over several faces is filled when the limit allows it") {
  TriMesh box = unit_box();
  for (int i = 0; i < 2; ++i) drop(box, box.triangles.size() - 1);  // the lid
  CHECK(repair_mesh(box).after.open_edges.count == 4);
  RepairSettings settings;
  settings.largest_hole_mm = 2.0;
  const RepairedMesh repaired = repair_mesh(box, settings);
  CHECK(repaired.after.sound());
  CHECK(repaired.after.volume_mm3 == doctest::Approx(1.0).epsilon(1e-12));
}

TEST_CASE("Flipped triangles and bodies inside out are turned") {
  TriMesh box = unit_box();
  std::swap(box.triangles[3][0], box.triangles[3][1]);
  const RepairedMesh repaired = repair_mesh(box);
  CHECK(done(repaired) == "3 edges whose triangles disagreed, mended by turning triangles round\n");
  CHECK(repaired.after.sound());

  TriMesh inside_out = unit_box();
  reverse_orientation(inside_out);
  const RepairedMesh turned = repair_mesh(inside_out);
  CHECK(contains(done(turned), "turned"));
  CHECK(turned.after.volume_mm3 == doctest::Approx(1.0));
}

TEST_CASE("Doubled triangles, slivers and cracks of rounding are mended") {
  TriMesh box = unit_box();
  box.triangles.push_back(box.triangles[5]);
  box.group.push_back(box.group[5]);
  CHECK(done(repair_mesh(box)) == "1 duplicate triangles removed\n");
  CHECK(repair_mesh(box).after.sound());

  // A crack of 2 um along an edge, closed when asked to weld over 5 um.
  TriMesh cracked = joined(unit_box(), TriMesh{});
  cracked.vertices.push_back(cracked.vertices[cracked.triangles[0][0]] + Vec3(2e-3, 0, 0));
  cracked.triangles[0][0] = static_cast<std::uint32_t>(cracked.vertices.size() - 1);
  CHECK_FALSE(diagnose(cracked).closed());
  RepairSettings weld;
  weld.weld_mm = 5e-3;
  CHECK(repair_mesh(cracked, weld).after.sound());
}

TEST_CASE("A fin and a wall inside are taken out") {
  TriMesh box = unit_box();
  const auto tip = static_cast<std::uint32_t>(box.vertices.size());
  box.vertices.emplace_back(2.0, 2.0, 2.0);
  box.triangles.push_back({box.triangles[0][0], box.triangles[0][1], tip});
  box.group.push_back(0);
  const RepairedMesh no_fin = repair_mesh(box);
  CHECK(done(no_fin) == "1 triangles of fins and inner walls removed\n");
  CHECK(no_fin.after.sound());

  // Two boxes whose common wall is there once: taken out, they are one.
  TriMesh two = welded(joined(unit_box(), unit_box({1, 0, 0})));
  // The wall of the second box repeats that of the first: leave one.
  std::vector<char> wanted(two.triangles.size(), 1);
  for (std::size_t t = 12; t < two.triangles.size(); ++t)
    if (two.area_vector(t).x() < -0.1) wanted[t] = 0;
  keep_triangles(two, wanted);
  const RepairedMesh one = repair_mesh(two);
  CHECK(contains(done(one), "2 triangles of fins and inner walls removed"));
  CHECK(one.after.sound());
  CHECK(one.after.volume_mm3 == doctest::Approx(2.0));
}

TEST_CASE("Bodies that cross, or share a whole wall, are united; their groups stay") {
  TriMesh crossing = joined(unit_box(), make_box({0.5, 0.25, 0.25}, {1.5, 0.75, 0.75}));
  const RepairedMesh united = repair_mesh(crossing);
  CHECK(done(united) == "1 pairs of bodies that cross or touch united\n");
  CHECK(united.after.sound());
  CHECK(united.after.bodies == 1);
  CHECK(united.after.volume_mm3 == doctest::Approx(1.0 + 0.125).epsilon(1e-9));
  double top = 0.0;
  for (std::size_t t = 0; t < united.mesh.triangles.size(); ++t)
    if (united.mesh.groups[united.mesh.group[t]] == "+z") top += united.mesh.area_vector(t).norm();
  CHECK(top == doctest::Approx(1.0 + 0.25).epsilon(1e-9));

  TriMesh glued = welded(joined(unit_box(), make_box({1, 0.25, 0.25}, {2, 0.75, 0.75})));
  const RepairedMesh one = repair_mesh(glued);
  CHECK(one.after.sound());
  CHECK(one.after.volume_mm3 == doctest::Approx(1.25).epsilon(1e-9));
}

TEST_CASE("Separate bodies and cavities stay as they are") {
  TriMesh two = joined(unit_box(), unit_box({3, 0, 0}));
  TriMesh cavity = make_box({0.25, 0.25, 0.25}, {0.75, 0.75, 0.75});
  reverse_orientation(cavity);
  two = joined(two, cavity);
  const RepairedMesh same = repair_mesh(two);
  CHECK(same.steps.empty());
  CHECK(same.after.bodies == 3);
  drop(two, 0);
  RepairSettings settings;
  settings.largest_hole_mm = 2.0;
  const RepairedMesh repaired = repair_mesh(two, settings);
  CHECK(repaired.after.sound());
  CHECK(repaired.after.bodies == 3);
  CHECK(repaired.after.volume_mm3 == doctest::Approx(2.0 - 0.125));
}

TEST_CASE("What cannot be mended is reported: sheets, and bodies that touch along an edge only") {
  TriMesh sheet = unit_box();
  while (sheet.triangles.size() > 2) drop(sheet, 2);
  RepairSettings settings;
  settings.largest_hole_mm = 10.0;
  const RepairedMesh open = repair_mesh(sheet, settings);
  CHECK(open.after.open_edges.count == 4);
  REQUIRE(open.refused.size() == 1);
  check_contains(open.refused[0], {"1 open sheet", "encloses nothing"});

  const RepairedMesh hinge = repair_mesh(welded(joined(unit_box(), unit_box({1, 1, 0}))));
  CHECK_FALSE(hinge.after.sound());
  REQUIRE(!hinge.refused.empty());
  CHECK(contains(hinge.refused[0], "touch along edges only"));
}

TEST_CASE("A mesh with vertices that nothing uses is diagnosed like one without") {
  TriMesh box = joined(unit_box(), unit_box({3, 0, 0}));
  box.vertices.insert(box.vertices.begin(), {Vec3(9, 9, 9), Vec3(-9, 9, 9)});
  for (auto& t : box.triangles)
    for (auto& v : t) v += 2;
  CHECK(diagnose(box).sound());
}
