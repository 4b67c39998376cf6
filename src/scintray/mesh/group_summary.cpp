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

/// Area to six digits: faces that a drawing has as equal differ by rounding.
double rounded_area(double area_mm2) {
  if (!(area_mm2 > 0.0)) return 0.0;
  const double unit = std::pow(10.0, std::floor(std::log10(area_mm2)) - 5.0);
  return std::round(area_mm2 / unit) * unit;
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Order of names in which numbers count by value.
bool natural_before(const std::string& a, const std::string& b) {
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (!is_digit(a[i]) || !is_digit(b[j])) {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i, ++j;
      continue;
    }
    const auto number = [](const std::string& text, std::size_t& at) {
      while (at < text.size() && text[at] == '0') ++at;
      const std::size_t first = at;
      while (at < text.size() && is_digit(text[at])) ++at;
      return text.substr(first, at - first);
    };
    const std::string one = number(a, i), other = number(b, j);
    if (one != other) return one.size() != other.size() ? one.size() < other.size() : one < other;
  }
  return a.size() - i != b.size() - j ? a.size() - i < b.size() - j : a < b;
}

}  // namespace

bool GroupSummary::flat() const {
  constexpr double kFlat = 1.0 - 1e-6;
  return area_mm2 > 0.0 && area_vector_mm2.norm() >= kFlat * area_mm2;
}

std::vector<GroupSummary> summarize_groups(const TriMesh& mesh) {
  std::map<std::string, GroupSummary, decltype(&natural_before)> by_name(&natural_before);
  std::map<std::string, std::uint32_t> support_of;
  for (std::size_t t = 0; t < mesh.triangles.size() && t < mesh.group.size(); ++t) {
    const std::string& name = mesh.groups.at(mesh.group[t]);
    GroupSummary& group = by_name[name];
    const core::Vec3 area = mesh.area_vector(t);
    group.name = name;
    group.area_mm2 += area.norm();
    group.centre += area.norm() * centre_of(mesh, t);
    group.area_vector_mm2 += area;
    const std::uint32_t support = mesh.support_of(t);
    const auto [first, is_first] = support_of.emplace(name, support);
    if (is_first && support != kNoSupport) group.round = mesh.supports[support].name();
    if (first->second != support) group.round.clear();
  }
  std::vector<GroupSummary> groups;
  for (auto& [name, group] : by_name) {
    if (group.area_mm2 > 0.0) group.centre /= group.area_mm2;
    groups.push_back(std::move(group));
  }
  std::stable_sort(groups.begin(), groups.end(), [](const GroupSummary& a, const GroupSummary& b) {
    return rounded_area(a.area_mm2) > rounded_area(b.area_mm2);
  });
  return groups;
}

std::string text_of(const GroupSummary& group) {
  char area[48];
  std::snprintf(area, sizeof area, "%.5g mm2", group.area_mm2);
  const std::string kind =
      group.flat() ? "flat, normal " + vector_text(group.area_vector_mm2 / group.area_vector_mm2.norm())
      : group.round.empty() ? "freeform"
                            : "round (" + group.round + ")";
  return std::string(area) + ", centre " + vector_text(group.centre) + " mm, " + kind;
}

}  // namespace scintray::mesh
