#include "scintray/contact/detail/boolean_difference.hpp"

#include <algorithm>
#include <map>

#include "scintray/contact/detail/geometry.hpp"

namespace scintray::contact {

namespace {

constexpr double kGrid_mm = 0x1p-30;

using Key = std::array<double, 3>;

Key key_of(const core::Vec3& v) { return {v.x(), v.y(), v.z()}; }

/// Rounds a mesh to the grid and keeps the original positions of its vertices.
mesh::TriMesh on_grid(mesh::TriMesh mesh, const Eigen::Matrix3d& axes, const core::Vec3& origin,
                      std::map<Key, core::Vec3>& own) {
  for (core::Vec3& vertex : mesh.vertices) {
    const core::Vec3 at = axes * (vertex - origin);
    const core::Vec3 rounded = (at / kGrid_mm).array().round() * kGrid_mm;
    own.try_emplace(key_of(rounded), vertex);
    vertex = rounded;
  }
  return mesh;
}

Eigen::AlignedBox3d bounds_of(const mesh::TriMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const core::Vec3& v : mesh.vertices) box.extend(v);
  return box;
}

/// Result of `combine(first, second, clean)` for both meshes rounded in `axes` about the middle of `part`.
template <typename Combine>
std::optional<mesh::BooleanResult> on_common_grid(const mesh::TriMesh& part, const mesh::TriMesh& tool,
                                                  const Eigen::Matrix3d& axes, double tolerance_mm,
                                                  Combine&& combine) {
  constexpr double kClean = 0.01;  // of the contact tolerance: shorter edges and heights are rounding
  const Eigen::AlignedBox3d box = bounds_of(part);
  const core::Vec3 origin = box.center();
  std::map<Key, core::Vec3> own;
  const mesh::TriMesh first = on_grid(part, axes, origin, own), second = on_grid(tool, axes, origin, own);
  // Not below what diagnose() treats as rounding.
  const double clean = std::max(kClean * tolerance_mm, 1.01 * std::ldexp(box.diagonal().norm(), -22));
  std::optional<mesh::BooleanResult> result = combine(first, second, clean);
  if (!result) return result;
  for (core::Vec3& vertex : result->mesh.vertices) {
    const auto known = own.find(key_of(vertex));
    vertex = known != own.end() ? known->second : core::Vec3(origin + axes.transpose() * vertex);
  }
  return result;
}

}  // namespace

Eigen::Matrix3d difference_axes(const std::vector<PlacedMesh>& parts) {
  std::vector<PlacedPart> geometry;
  for (const PlacedMesh& part : parts) geometry.push_back(geometry_of(part));
  return natural_axes(geometry);
}

std::optional<mesh::BooleanResult> difference_on_grid(const mesh::TriMesh& part, const mesh::TriMesh& tool,
                                                      const Eigen::Matrix3d& axes, double tolerance_mm) {
  return on_common_grid(part, tool, axes, tolerance_mm,
                        [](const mesh::TriMesh& a, const mesh::TriMesh& b, double clean) {
                          return mesh::boolean(a, b, mesh::BooleanOperation::subtract, clean);
                        });
}

std::optional<mesh::BooleanResult> imprint_on_grid(const mesh::TriMesh& part, const mesh::TriMesh& tool,
                                                   const Eigen::Matrix3d& axes, double tolerance_mm) {
  return on_common_grid(part, tool, axes, tolerance_mm, mesh::imprint);
}

PlacedPart geometry_of(const PlacedMesh& part) {
  std::vector<core::FaceId> faces;
  faces.reserve(part.face_of.size());
  for (const std::uint32_t face : part.face_of) faces.emplace_back(face);
  return {part.name, part.mesh.vertices, part.mesh.triangles, std::move(faces), part.where};
}

}  // namespace scintray::contact
