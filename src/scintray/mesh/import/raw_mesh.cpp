#include "scintray/mesh/import/raw_mesh.hpp"

#include <algorithm>
#include <array>

#include "scintray/mesh/shapes/polygon.hpp"

namespace scintray::mesh {

namespace {

/// Length of the character of UTF-8 (RFC 3629) at the start of `text`; 0 for bytes that are none.
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xC0) != 0x80) return 0;
  const unsigned second = byte(1);  // too long a form, a surrogate, or beyond Unicode
  if ((first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F) ||
      (first == 0xF0 && second < 0x90) || (first == 0xF4 && second > 0x8F))
    return 0;
  return length;
}

}  // namespace

std::string plain_name(std::string_view name) {
  std::string plain;
  while (!name.empty()) {
    const std::size_t length = utf8_length(name);
    const auto first = static_cast<unsigned char>(name.front());
    const bool control = length == 2 ? first == 0xC2 && static_cast<unsigned char>(name[1]) < 0xA0
                                     : length < 2 && (first < 0x20 || (first >= 0x7F && first < 0xA0));
    if (control)
      plain += '_';
    else if (length > 0)
      plain += name.substr(0, length);
    else
      plain += {static_cast<char>(0xC0 | (first >> 6)), static_cast<char>(0x80 | (first & 0x3F))};
    name.remove_prefix(length == 0 ? 1 : length);
  }
  return plain;
}

std::string group_name(const std::string& object, const std::string& material) {
  if (object.empty()) return material.empty() ? "default" : material;
  return material.empty() ? object : object + ":" + material;
}

void RawMesh::begin_body(const std::string& name) {
  fill_body();
  const std::string base = name.empty() ? "body" : plain_name(name);
  std::string unique = base;
  for (int number = 2; std::find(bodies.begin(), bodies.end(), unique) != bodies.end(); ++number)
    unique = base + " " + std::to_string(number);
  bodies.push_back(unique);
}

void RawMesh::fill_body() {
  if (!bodies.empty()) body_of.resize(mesh.triangles.size(), static_cast<std::uint32_t>(bodies.size() - 1));
}

bool RawMesh::add_polygon(const std::vector<std::uint32_t>& corners, std::uint32_t group_of_polygon,
                          bool mirrored) {
  if (corners.size() < 3) {
    ++points_and_lines;
    return true;
  }
  if (corners.size() > kMostCorners) return false;
  std::vector<core::Vec3> points;
  points.reserve(corners.size());
  for (const std::uint32_t corner : corners) points.push_back(mesh.vertices[corner]);
  bool simple = true;
  for (const auto& [i, j, k] : triangulate_polygon(points, simple)) {
    const std::uint32_t a = corners[i], b = corners[j], c = corners[k];
    mesh.triangles.push_back(mirrored ? std::array{a, c, b} : std::array{a, b, c});
    mesh.group.push_back(group_of_polygon);
  }
  if (!simple) ++crossing_polygons;
  return true;
}

}  // namespace scintray::mesh
