#include "scintray/mesh/group_summary.hpp"

#include <doctest/doctest.h>

#include "scintray/mesh/shapes/primitives.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::mesh;

namespace {

const GroupSummary& group_of(const std::vector<GroupSummary>& groups, const std::string& name) {
  for (const GroupSummary& group : groups)
    if (group.name == name) return group;
  FAIL("there is no group " << name);
  return groups.front();
}

}  // namespace

TEST_CASE("Groups are flat, round or freeform") {
  TriMesh cylinder = make_cylinder(1.0, 2.0, 64);
  const std::vector<GroupSummary> groups = summarize_groups(cylinder);
  CHECK(group_of(groups, "side").round == "cylinder");
  CHECK(text_of(group_of(groups, "side")).find("round (cylinder)") != std::string::npos);
  CHECK(group_of(groups, "+z").flat());
  CHECK(text_of(group_of(groups, "+z")).find("flat, normal (0, 0, 1)") != std::string::npos);
  CHECK(group_of(groups, "+z").area_mm2 == doctest::Approx(kPi).epsilon(2e-3));
  CHECK(group_of(groups, "+z").centre.isApprox(Vec3(0, 0, 2), 1e-9));
  const TriMesh ball = make_sphere(1.0, 4);
  CHECK(summarize_groups(ball).front().round == "sphere");

  cylinder.supports.clear();
  cylinder.support.clear();
  const std::vector<GroupSummary> triangles_only = summarize_groups(cylinder);
  CHECK(group_of(triangles_only, "side").round.empty());
  CHECK_FALSE(group_of(triangles_only, "side").flat());
  CHECK(text_of(group_of(triangles_only, "side")).find("freeform") != std::string::npos);
}

TEST_CASE("A group of two surfaces is freeform") {
  TriMesh two = make_cylinder(1.0, 2.0, 64);
  TriMesh ball = make_sphere(1.0, 4);
  ball.groups = {"side"};
  const std::vector<GroupSummary> groups = summarize_groups(joined(two, ball));
  CHECK(group_of(groups, "side").round.empty());
}

TEST_CASE("The largest group comes first, and equal ones by their numbers") {
  TriMesh box = make_box({0, 0, 0}, {1, 1, 2});
  box.groups = {"face10", "face2", "face1", "face03", "end20", "end3"};
  std::vector<std::string> names;
  for (const GroupSummary& group : summarize_groups(box)) names.push_back(group.name);
  CHECK(names == std::vector<std::string>{"face1", "face2", "face03", "face10", "end3", "end20"});
}
