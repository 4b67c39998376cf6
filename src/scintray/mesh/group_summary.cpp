#include "scintray/mesh/group_summary.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

namespace scintray::mesh {

namespace {

std::string vector_text(const core::Vec3& v) {
  constexpr double kNoise = 5e-7;
  const auto rounded = [](double x) { return std::abs(x) < kNoise ? 0.0 : x; };
  char text[96];
  std::snprintf(text, sizeof text, "(%.5g, %.5g, %.5g)", rounded(v.x()), rounded(v.y()), rounded(v.z()));
  return text;
}

}  // namespace

bool GroupSummary::flat() const {
  constexpr double kFlat = 1.0 - 1e-6;
  return area_mm2 > 0.0 && area_vector_mm2.norm() >= kFlat * area_mm2;
}

std::vector<GroupSummary> summarize_groups(const TriMesh& mesh) {
  std::map<std::string, GroupSummary> by_name;
  for (std::size_t t = 0; t < mesh.triangles.size() && t < mesh.group.size(); ++t) {
    const std::string& name = mesh.groups.at(mesh.group[t]);
    GroupSummary& group = by_name[name];
    const core::Vec3 area = mesh.area_vector(t);
    group.name = name;
    group.area_mm2 += area.norm();
    group.centre += area.norm() * centre_of(mesh, t);
    group.area_vector_mm2 += area;
  }
  std::vector<GroupSummary> groups;
  for (auto& [name, group] : by_name) {
    if (group.area_mm2 > 0.0) group.centre /= group.area_mm2;
    groups.push_back(std::move(group));
  }
  std::stable_sort(groups.begin(), groups.end(),
                   [](const GroupSummary& a, const GroupSummary& b) { return a.area_mm2 > b.area_mm2; });
  return groups;
}

std::string text_of(const GroupSummary& group) {
  char area[48];
  std::snprintf(area, sizeof area, "%.5g mm2", group.area_mm2);
  return std::string(area) + ", centre " + vector_text(group.centre) + " mm, " +
         (group.flat() ? "normal " + vector_text(group.area_vector_mm2 / group.area_vector_mm2.norm())
                       : "curved");
}

}  // namespace scintray::mesh
