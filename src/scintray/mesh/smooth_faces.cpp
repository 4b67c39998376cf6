#include "scintray/mesh/smooth_faces.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/mesh/detail/edges.hpp"

namespace scintray::mesh {

namespace {

/// Angle between facets beyond which their edge is one of the body.
constexpr double kSharpest = 30.0 * core::kDegree;
/// Angle below which triangles lie in one plane but for rounding.
constexpr double kFlattest = 1e-5;

}  // namespace

std::vector<FacetDeviation> smooth_face_deviations(const TriMesh& mesh,
                                                   const std::vector<std::uint32_t>& face_of,
                                                   std::size_t faces) {
  std::vector<FacetDeviation> largest(faces);
  for_each_edge(sorted_edge_uses(mesh), [&](const EdgeUse* first, const EdgeUse* last) {
    if (last - first != 2) return;
    const std::uint32_t a = first->low, b = first->high, t = first[0].triangle, other = first[1].triangle;
    if (face_of[t] != face_of[other] || mesh.support_of(t) != kNoSupport ||
        mesh.support_of(other) != kNoSupport)
      return;
    const core::Vec3 one = mesh.area_vector(t), two = mesh.area_vector(other);
    const double angle = angle_between(one, two);
    if (!(angle > kFlattest) || angle > kSharpest) return;
    const double length = (mesh.vertices[a] - mesh.vertices[b]).norm();
    const double width = 2.0 * std::max(one.norm(), two.norm()) / length;
    FacetDeviation& deviation = largest[face_of[t]];
    deviation.angle_rad = std::max(deviation.angle_rad, 0.5 * angle);
    deviation.distance_mm = std::max(deviation.distance_mm, width * angle / 8.0);
  });
  return largest;
}

}  // namespace scintray::mesh
