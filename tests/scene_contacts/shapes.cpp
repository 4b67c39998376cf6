#include "shapes.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>

#include "scintray/core/id_vector.hpp"

namespace scintray::test {

contact::PlacedPart box(const std::string& name, const core::Vec3& low, const core::Vec3& high,
                        std::uint32_t first_face, int cuts, bool other_diagonal) {
  contact::PlacedPart part;
  part.name = name;
  const auto at = [&](int axis, int i) {
    if (i == 0) return low[axis];
    return i == cuts ? high[axis] : low[axis] + (high[axis] - low[axis]) * i / cuts;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (int end = 0; end < 2; ++end) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      const auto first = static_cast<std::uint32_t>(part.vertices.size());
      for (int i = 0; i <= cuts; ++i)
        for (int j = 0; j <= cuts; ++j) {
          core::Vec3 p;
          p[axis] = end == 0 ? low[axis] : high[axis];
          p[u] = at(u, i);
          p[v] = at(v, j);
          part.vertices.push_back(p);
        }
      const auto id = [&](int i, int j) { return first + static_cast<std::uint32_t>(i * (cuts + 1) + j); };
      for (int i = 0; i < cuts; ++i)
        for (int j = 0; j < cuts; ++j) {
          std::array<std::uint32_t, 4> quad{id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)};
          if (end == 0) std::reverse(quad.begin(), quad.end());
          if (other_diagonal) std::rotate(quad.begin(), quad.begin() + 1, quad.end());
          part.triangles.push_back({quad[0], quad[1], quad[2]});
          part.triangles.push_back({quad[0], quad[2], quad[3]});
          part.face.insert(part.face.end(), 2,
                           core::FaceId(first_face + static_cast<std::uint32_t>(2 * axis + end)));
        }
    }
  return part;
}

contact::PlacedPart prism(const std::string& name, const std::vector<Eigen::Vector2d>& outline, double z_low,
                          double z_high, std::uint32_t first_face) {
  contact::PlacedPart part;
  part.name = name;
  const auto n = static_cast<std::uint32_t>(outline.size());
  for (const double z : {z_low, z_high})
    for (const auto& p : outline) part.vertices.emplace_back(p.x(), p.y(), z);
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t face) {
    part.triangles.push_back({a, b, c});
    part.face.emplace_back(first_face + face);
  };
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    add(i, j, n + j, i);
    add(i, n + j, n + i, i);
    if (i == 0 || j == 0) continue;
    add(0, j, i, n);
    add(n, n + i, n + j, n + 1);
  }
  return part;
}

void move(std::vector<contact::PlacedPart>& parts, const Eigen::Matrix3d& rotation, const core::Vec3& shift) {
  for (contact::PlacedPart& part : parts)
    for (core::Vec3& v : part.vertices) v = rotation * v + shift;
}

Eigen::Matrix3d skew_rotation() {
  return Eigen::AngleAxisd(0.8137, core::Vec3(0.3, -0.5, 0.7).normalized()).toRotationMatrix();
}

void round_to_float(std::vector<contact::PlacedPart>& parts) {
  for (contact::PlacedPart& part : parts)
    for (core::Vec3& v : part.vertices) v = v.cast<float>().cast<double>();
}

namespace {
core::Vec3 area_vector(const contact::InterfaceTriangle& t) {
  return 0.5 * (t.vertex[1] - t.vertex[0]).cross(t.vertex[2] - t.vertex[0]);
}
}  // namespace

double area(const contact::InterfaceTriangle& triangle) { return area_vector(triangle).norm(); }

double area_between(const std::vector<contact::InterfaceTriangle>& interfaces, core::PartId a,
                    core::PartId b) {
  double sum = 0.0;
  for (const contact::InterfaceTriangle& t : interfaces)
    if ((t.back == a && t.front == b) || (t.back == b && t.front == a)) sum += area(t);
  return sum;
}

std::map<core::PartId, Boundary> boundaries(const std::vector<contact::InterfaceTriangle>& interfaces) {
  std::map<core::PartId, Boundary> result;
  if (interfaces.empty()) return result;
  const core::Vec3 origin = interfaces.front().vertex[0];
  for (const contact::InterfaceTriangle& t : interfaces)
    for (const auto& [region, sign] : {std::pair(t.back, 1.0), std::pair(t.front, -1.0)}) {
      Boundary& boundary = result[region];
      const core::Vec3 v = sign * area_vector(t);
      boundary.area_vector += v;
      boundary.area += v.norm();
      boundary.volume += v.dot((t.vertex[0] + t.vertex[1] + t.vertex[2]) / 3.0 - origin) / 3.0;
    }
  return result;
}

void check_laws(const std::vector<contact::PlacedPart>& parts,
                const std::vector<contact::InterfaceTriangle>& interfaces, const std::vector<double>& volumes,
                double slack_mm) {
  double largest = 0.0;
  for (const contact::PlacedPart& part : parts)
    for (const core::Vec3& v : part.vertices) largest = std::max(largest, v.cwiseAbs().maxCoeff());
  double extent = 0.0;
  for (const contact::PlacedPart& part : parts)
    for (const core::Vec3& v : part.vertices) extent = std::max(extent, (v - parts[0].vertices[0]).norm());
  // A face is known to some roundings of the largest coordinate.
  const double rounding = 256.0 * std::numeric_limits<double>::epsilon() * largest;

  core::IdVector<core::PartId, std::set<core::FaceId>> faces;
  for (const contact::PlacedPart& part : parts) faces.emplace_back(part.face.begin(), part.face.end());
  bool sides_differ = true, has_face = true, faces_belong = true;
  for (const contact::InterfaceTriangle& t : interfaces) {
    sides_differ = sides_differ && t.back != t.front;
    has_face = has_face && t.back_face.has_value();
    for (const auto& [region, face] : {std::pair(t.back, t.back_face), std::pair(t.front, t.front_face)})
      if (face.has_value())
        faces_belong = faces_belong && region != contact::kAmbient && faces[region].contains(face);
  }
  CHECK(sides_differ);
  CHECK(has_face);
  CHECK(faces_belong);

  const auto all = boundaries(interfaces);
  REQUIRE(volumes.size() == parts.size());
  for (const auto& row : all) {
    const auto& region = row.first;
    const auto& boundary = row.second;
    CAPTURE(region.has_value() ? static_cast<int>(region.index()) : -1);
    CHECK(boundary.area_vector.norm() <= rounding * std::sqrt(boundary.area * interfaces.size()));
    if (region == contact::kAmbient) continue;
    CHECK(std::abs(boundary.volume - volumes[region.index()]) <=
          boundary.area * (slack_mm + rounding) + rounding * extent * std::sqrt(boundary.area));
  }
  for (std::size_t i = 0; i < volumes.size(); ++i) CHECK(all.contains(core::PartId(i)) == (volumes[i] > 0.0));
}

}  // namespace scintray::test
