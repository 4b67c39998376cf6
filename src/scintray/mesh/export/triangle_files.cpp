#include "scintray/mesh/export/triangle_files.hpp"

#include <bit>
#include <cstdint>
#include <string>

#include "scintray/core/output_file.hpp"

namespace scintray::mesh {
namespace {

/// The lowest `size` bytes of a number, the lowest first.
template <typename Value>
void append(std::string& bytes, Value value, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) bytes.push_back(static_cast<char>(value >> (8 * i) & 0xFFU));
}

void append_single_precision(std::string& bytes, const core::Vec3& v) {
  for (int axis = 0; axis < 3; ++axis)
    append(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(v[axis])), 4);
}

}  // namespace

void write_stl(const std::filesystem::path& path, const TriMesh& mesh) {
  // Must not begin with "solid", which readers take for an ASCII file.
  std::string bytes = "ScintRay triangle mesh, millimetres";
  bytes.resize(80, ' ');
  append(bytes, static_cast<std::uint32_t>(mesh.triangles.size()), 4);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const core::Vec3 area = mesh.area_vector(t);
    append_single_precision(
        bytes, area.norm() > 0.0 ? core::Vec3(area.normalized()) : core::Vec3(core::Vec3::Zero()));
    for (const std::uint32_t vertex : mesh.triangles[t])
      append_single_precision(bytes, mesh.vertices[vertex]);
    bytes.append(2, '\0');
  }
  core::write_whole_file(path, bytes);
}

void write_ply(const std::filesystem::path& path, const TriMesh& mesh) {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\ncomment ScintRay triangle mesh, millimetres\nelement vertex " +
      std::to_string(mesh.vertices.size()) +
      "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
      std::to_string(mesh.triangles.size()) + "\nproperty list uchar uint vertex_indices\nend_header\n";
  for (const core::Vec3& vertex : mesh.vertices)
    for (int axis = 0; axis < 3; ++axis) append(bytes, std::bit_cast<std::uint64_t>(vertex[axis]), 8);
  for (const auto& triangle : mesh.triangles) {
    bytes.push_back(3);
    for (const std::uint32_t vertex : triangle) append(bytes, vertex, 4);
  }
  core::write_whole_file(path, bytes);
}

}  // namespace scintray::mesh
