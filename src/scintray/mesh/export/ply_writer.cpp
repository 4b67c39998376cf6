#include "scintray/mesh/export/ply_writer.hpp"

#include <bit>
#include <string>

#include "scintray/core/output_file.hpp"

namespace scintray::mesh {
namespace {

template <typename Value>
void append(std::string& bytes, Value value, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) bytes.push_back(static_cast<char>(value >> (8 * i) & 0xFFU));
}

}  // namespace

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
