#include "scintray/mesh/export/stl_writer.hpp"

#include <bit>
#include <string>

#include "scintray/core/output_file.hpp"

namespace scintray::mesh {
namespace {

void append_u32(std::string& bytes, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<char>((value >> shift) & 0xFFU));
}

void append_vector(std::string& bytes, const core::Vec3& v) {
  for (int axis = 0; axis < 3; ++axis) {
    append_u32(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(v[axis])));
  }
}

}  // namespace

void write_stl(const std::filesystem::path& path, const TriMesh& mesh) {
  // Must not begin with "solid", which readers take for an ASCII file.
  std::string bytes = "ScintRay triangle mesh, millimetres";
  bytes.resize(80, ' ');
  append_u32(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const core::Vec3 area = mesh.area_vector(t);
    append_vector(bytes, area.norm() > 0.0 ? core::Vec3(area.normalized()) : core::Vec3(core::Vec3::Zero()));
    for (const std::uint32_t vertex : mesh.triangles[t]) append_vector(bytes, mesh.vertices[vertex]);
    bytes.append(2, '\0');
  }
  core::write_whole_file(path, bytes);
}

}  // namespace scintray::mesh
