#include "scintray/mesh/smooth_faces.hpp"

#include <algorithm>
#include <cmath>
#include <compare>

namespace scintray::mesh {

namespace {

/// Angle between facets beyond which their edge is one of the body.
constexpr double kSharpest = 30.0 * core::kDegree;
/// Angle below which triangles lie in one plane but for rounding.
constexpr double kFlattest = 1e-5;

/// A side of a triangle, between the corners `low` and `high`.
struct Side {
  std::uint32_t low, high, triangle;
  auto operator<=>(const Side&) const = default;
};

double angle_between(const core::Vec3& a, const core::Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

std::vector<FacetDeviation> smooth_face_deviations(const TriMesh& mesh,
                                                   const std::vector<std::uint32_t>& face_of,
                                                   std::size_t faces) {
  std::vector<FacetDeviation> largest(faces);
  // A sorted list: maps take seconds for parts of a million triangles.
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = mesh.triangles[t][k], to = mesh.triangles[t][(k + 1) % 3];
      sides.push_back({std::min(from, to), std::max(from, to), t});
    }
  std::sort(sides.begin(), sides.end());
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    const auto [a, b, t] = sides[i];
    const std::uint32_t other = sides[i + 1].triangle;
    if (sides[i + 1].low != a || sides[i + 1].high != b) continue;
    if (face_of[t] != face_of[other] || mesh.support_of(t) != kNoSupport ||
        mesh.support_of(other) != kNoSupport)
      continue;
    const core::Vec3 one = mesh.area_vector(t), two = mesh.area_vector(other);
    const double angle = angle_between(one, two);
    if (!(angle > kFlattest) || angle > kSharpest) continue;
    const double length = (mesh.vertices[a] - mesh.vertices[b]).norm();
    const double width = 2.0 * std::max(one.norm(), two.norm()) / length;
    FacetDeviation& deviation = largest[face_of[t]];
    deviation.angle_rad = std::max(deviation.angle_rad, 0.5 * angle);
    deviation.distance_mm = std::max(deviation.distance_mm, width * angle / 8.0);
  }
  return largest;
}

}  // namespace scintray::mesh
