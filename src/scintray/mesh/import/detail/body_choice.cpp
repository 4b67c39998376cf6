#include "scintray/mesh/import/detail/import_steps.hpp"

#include <algorithm>
#include <charconv>
#include <map>
#include <unordered_map>
#include <utility>

#include "scintray/core/error.hpp"
#include "scintray/core/text.hpp"
#include "scintray/mesh/import/file_checks.hpp"
#include "scintray/mesh/weld.hpp"

namespace scintray::mesh {
namespace {

std::string first_names(std::span<const std::string> names) {
  constexpr std::size_t kMost = 20;
  return core::list_quoted(names.first(std::min(names.size(), kMost))) +
         (names.size() > kMost ? " and more" : "");
}

/// Index of the body called or numbered `wanted`.
std::size_t find_body(const std::filesystem::path& path, const RawMesh& raw, const std::string& wanted) {
  const auto named = std::find(raw.bodies.begin(), raw.bodies.end(), wanted);
  if (named != raw.bodies.end()) return static_cast<std::size_t>(named - raw.bodies.begin());
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), number);
  if (error == std::errc() && end == wanted.data() + wanted.size() && number >= 1 &&
      number <= raw.bodies.size())
    return number - 1;
  if (raw.bodies.empty())
    reject_file(path, "the file has no bodies to choose \"" + wanted + "\" from", "remove body");
  const std::string near = core::nearest_word(wanted, raw.bodies);
  reject_file(path, "the file has no body \"" + wanted + "\"",
              (near.empty() ? "" : "did you mean \"" + near + "\"? ") + "its bodies are " +
                  first_names(raw.bodies) + ", numbered from 1");
}

void drop_unused_groups(TriMesh& mesh) {
  TriMesh named;
  std::map<std::uint32_t, std::uint32_t> renumbered;
  for (std::uint32_t& group : mesh.group) {
    const auto [entry, is_new] = renumbered.try_emplace(group, 0);
    if (is_new) entry->second = named.group_index(mesh.groups[group], mesh.tags_of(group));
    group = entry->second;
  }
  mesh.groups = std::move(named.groups);
  mesh.group_tags = std::move(named.group_tags);
}

void drop_unused_supports(TriMesh& mesh) {
  const std::vector<SupportSurface> all = std::exchange(mesh.supports, {});
  for (std::uint32_t& support : mesh.support)
    if (support != kNoSupport) support = mesh.support_index(all[support]);
  if (mesh.supports.empty()) mesh.support.clear();
}

void keep_body(TriMesh& mesh, const std::vector<std::uint32_t>& body_of, std::uint32_t body) {
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (body_of[t] != body) continue;
    mesh.triangles[kept] = mesh.triangles[t];
    if (!mesh.support.empty()) mesh.support[kept] = mesh.support[t];
    mesh.group[kept++] = mesh.group[t];
  }
  mesh.triangles.resize(kept);
  mesh.group.resize(kept);
  if (!mesh.support.empty()) mesh.support.resize(kept);
  drop_unused_supports(mesh);
  drop_unused_vertices(mesh);
  drop_unused_groups(mesh);
}

}  // namespace

void choose_body(const std::filesystem::path& path, RawMesh& raw, const std::string& wanted) {
  if (wanted.empty()) {
    if (raw.bodies.size() > 1)
      raw.notes.push_back("the file has " + std::to_string(raw.bodies.size()) +
                          " bodies, all imported together as one part: " + first_names(raw.bodies) +
                          "; body = \"NAME\" takes one");
    return;
  }
  keep_body(raw.mesh, raw.body_of, static_cast<std::uint32_t>(find_body(path, raw, wanted)));
}

RawMesh copy_of_body(const std::filesystem::path& path, const RawMesh& raw, const std::string& wanted) {
  const std::size_t body = find_body(path, raw, wanted);
  RawMesh copy;
  copy.unit = raw.unit;
  copy.notes = raw.notes;
  copy.points_and_lines = raw.points_and_lines;
  copy.crossing_polygons = raw.crossing_polygons;
  copy.deviation_mm = raw.deviation_mm;
  std::vector<std::uint32_t> vertices;  // of the body, ascending
  for (std::size_t t = 0; t < raw.mesh.triangles.size(); ++t) {
    if (raw.body_of[t] != body) continue;
    const auto& triangle = raw.mesh.triangles[t];
    copy.mesh.triangles.push_back(triangle);
    copy.mesh.group.push_back(raw.mesh.group[t]);
    if (!raw.mesh.support.empty()) copy.mesh.support.push_back(raw.mesh.support[t]);
    vertices.insert(vertices.end(), triangle.begin(), triangle.end());
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  for (const std::uint32_t v : vertices) copy.mesh.vertices.push_back(raw.mesh.vertices[v]);
  for (auto& triangle : copy.mesh.triangles)
    for (std::uint32_t& v : triangle)
      v = static_cast<std::uint32_t>(std::lower_bound(vertices.begin(), vertices.end(), v) -
                                     vertices.begin());

  std::unordered_map<std::uint32_t, std::uint32_t> groups, supports;
  for (std::uint32_t& group : copy.mesh.group) {
    const auto [entry, is_new] = groups.try_emplace(group, 0);
    if (is_new) entry->second = copy.mesh.group_index(raw.mesh.groups[group], raw.mesh.tags_of(group));
    group = entry->second;
  }
  for (std::uint32_t& support : copy.mesh.support) {
    if (support == kNoSupport) continue;
    const auto [entry, is_new] = supports.try_emplace(support, 0);
    if (is_new) entry->second = copy.mesh.support_index(raw.mesh.supports[support]);
    support = entry->second;
  }
  if (copy.mesh.supports.empty()) copy.mesh.support.clear();
  return copy;
}

}  // namespace scintray::mesh
