#include "scintray/mesh/trimesh.hpp"

#include <algorithm>
#include <charconv>

namespace scintray::mesh {

core::Vec3 TriMesh::area_vector(std::size_t triangle) const {
  const auto& [a, b, c] = triangles[triangle];
  return 0.5 * (vertices[b] - vertices[a]).cross(vertices[c] - vertices[a]);
}

double TriMesh::area() const {
  double sum = 0.0;
  for (std::size_t t = 0; t < triangles.size(); ++t) sum += area_vector(t).norm();
  return sum;
}

double TriMesh::volume() const {
  if (triangles.empty()) return 0.0;
  // Tetrahedra from a vertex of the mesh: for a mesh far from the origin, those from the origin would cancel.
  const core::Vec3 apex = vertices[triangles.front()[0]];
  double sum = 0.0;
  for (const auto& [a, b, c] : triangles) {
    sum += (vertices[a] - apex).dot((vertices[b] - apex).cross(vertices[c] - apex)) / 6.0;
  }
  return sum;
}

std::string tag_text(double number) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, number).ptr};
}

const FaceTags& TriMesh::tags_of(std::size_t group_number) const {
  static const FaceTags none;
  return group_number < group_tags.size() ? group_tags[group_number] : none;
}

std::uint32_t TriMesh::group_index(const std::string& name, const FaceTags& tags) {
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (groups[g] == name && tags_of(g) == tags) return static_cast<std::uint32_t>(g);
  groups.push_back(name);
  if (!tags.empty() || !group_tags.empty()) {
    group_tags.resize(groups.size());
    group_tags.back() = tags;
  }
  return static_cast<std::uint32_t>(groups.size() - 1);
}

std::uint32_t TriMesh::support_index(const SupportSurface& surface) {
  const auto found = std::find_if(supports.begin(), supports.end(),
                                  [&](const SupportSurface& known) { return known.is_same(surface); });
  if (found != supports.end()) return static_cast<std::uint32_t>(found - supports.begin());
  supports.push_back(surface);
  return static_cast<std::uint32_t>(supports.size() - 1);
}

void TriMesh::set_support(const SupportSurface& surface, std::size_t first, std::size_t last) {
  support.resize(triangles.size(), kNoSupport);
  for (std::size_t t = first; t < last; ++t) support[t] = static_cast<std::uint32_t>(supports.size());
  supports.push_back(surface);
}

core::Vec3 centre_of(const TriMesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3.0;
}

void keep_triangles(TriMesh& mesh, const std::vector<char>& wanted) {
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!wanted[t]) continue;
    mesh.triangles[kept] = mesh.triangles[t];
    if (!mesh.group.empty()) mesh.group[kept] = mesh.group[t];
    if (!mesh.support.empty()) mesh.support[kept] = mesh.support[t];
    ++kept;
  }
  mesh.triangles.resize(kept);
  if (!mesh.group.empty()) mesh.group.resize(kept);
  if (!mesh.support.empty()) mesh.support.resize(kept);
}

void translate(TriMesh& mesh, const core::Vec3& by) {
  for (core::Vec3& vertex : mesh.vertices) vertex += by;
  for (SupportSurface& surface : mesh.supports) surface.origin += by;
}

}  // namespace scintray::mesh
