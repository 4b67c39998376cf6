#include "scintray/contact/detail/facing.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/core/linear_solutions.hpp"
#include "scintray/mesh/triangle_distance.hpp"

namespace scintray::contact {

std::vector<core::Vec3> samples_of(const core::Vec3& a, const core::Vec3& b, const core::Vec3& c) {
  constexpr int kSteps = 6;
  std::vector<core::Vec3> points;
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; i + j <= kSteps; ++j) points.push_back((i * a + j * b + (kSteps - i - j) * c) / kSteps);
  return points;
}
std::vector<core::Vec3> samples_of(const Body& body, std::uint32_t t) {
  return samples_of(body.corner(t, 0), body.corner(t, 1), body.corner(t, 2));
}

Nearest nearest(const Body& body, const core::Vec3& point, const core::Vec3& normal, bool opposed,
                double reach, const std::vector<char>* only) {
  constexpr double kAligned = 0.7;
  Nearest best;
  for (const std::uint32_t t : body.tree.touching(body.box_of(point, point).grown(reach))) {
    if (only != nullptr && !only->empty() && !(*only)[t]) continue;
    const double cosine = body.normal[t].dot(normal) * (opposed ? -1.0 : 1.0);
    if (cosine < kAligned) continue;
    const double d =
        mesh::distance_to_triangle(point, body.corner(t, 0), body.corner(t, 1), body.corner(t, 2));
    if (d <= reach && std::pair(d, t) < std::pair(best.distance, best.triangle)) best = {t, d};
  }
  return best;
}

std::vector<Facing> facing(const Body& body, const Body& other, const ContactReach& reach,
                           const Contactable& only) {
  const auto counts = [](const std::vector<char>& mask, std::uint32_t t) { return mask.empty() || mask[t]; };
  std::vector<Facing> result(body.triangles.size(), Facing::none);
  std::vector<char> touched(body.triangles.size(), 0);
  std::vector<double> farthest(body.triangles.size(), 0.0);
  for (std::uint32_t t = 0; t < other.triangles.size(); ++t) {
    if (!counts(only.of_other, t)) continue;
    for (const core::Vec3& point : samples_of(other, t))
      if (const Nearest n = nearest(body, point, other.normal[t], true, reach.tolerance, &only.of_body);
          n.found()) {
        touched[n.triangle] = 1;
        farthest[n.triangle] = std::max(farthest[n.triangle], n.distance);
      }
  }
  for (std::uint32_t t = 0; t < body.triangles.size(); ++t) {
    if (!counts(only.of_body, t)) continue;
    std::size_t near = 0;
    const auto points = samples_of(body, t);
    for (const core::Vec3& point : points)
      if (const Nearest n = nearest(other, point, body.normal[t], true, reach.tolerance, &only.of_other);
          n.found()) {
        ++near;
        farthest[t] = std::max(farthest[t], n.distance);
      }
    if (near == points.size()) {
      result[t] = Facing::covered;
    } else if (near > 0 || touched[t]) {
      result[t] = farthest[t] <= reach.flat ? Facing::flat : Facing::partly;
    }
  }
  return result;
}

mesh::TriMesh pushed(mesh::TriMesh mesh, const Body& body, const std::vector<char>& marked, double by) {
  constexpr double kRankThreshold = 1e-3;
  std::vector<double> area(mesh.triangles.size());
  for (std::uint32_t t = 0; t < area.size(); ++t) area[t] = mesh.area_vector(t).norm();
  std::vector<std::vector<std::uint32_t>> around(mesh.vertices.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t v : mesh.triangles[t]) around[v].push_back(t);
  for (std::uint32_t v = 0; v < around.size(); ++v) {
    if (std::none_of(around[v].begin(), around[v].end(), [&](std::uint32_t t) { return marked[t]; }))
      continue;
    Eigen::MatrixXd planes(around[v].size(), 3);
    Eigen::VectorXd shifts(around[v].size());
    double largest = 0.0;
    for (const std::uint32_t t : around[v]) largest = std::max(largest, area[t]);
    for (std::size_t k = 0; k < around[v].size(); ++k) {
      const std::uint32_t t = around[v][k];
      const double weight = std::sqrt(area[t] / largest);
      planes.row(static_cast<Eigen::Index>(k)) = weight * body.normal[t];
      shifts(static_cast<Eigen::Index>(k)) = marked[t] ? weight * by : 0.0;
    }
    mesh.vertices[v] += core::least_solution(planes, shifts, kRankThreshold).x;
  }
  return mesh;
}

}  // namespace scintray::contact
