#include "scintray/mesh/shapes/primitives.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "scintray/mesh/shapes/shape_error.hpp"

namespace scintray::mesh {
namespace {

bool positive(double x) { return std::isfinite(x) && x > 0.0; }

void add_triangle(TriMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t group) {
  mesh.triangles.push_back({a, b, c});
  mesh.group.push_back(group);
}

std::uint32_t add_vertex(TriMesh& mesh, const core::Vec3& point) {
  mesh.vertices.push_back(point);
  return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

TriMesh icosahedron() {
  TriMesh mesh;
  mesh.groups = {"sphere"};
  const double golden = 0.5 * (1.0 + std::sqrt(5.0));
  for (const double one : {-1.0, 1.0}) {
    for (const double ratio : {-golden, golden}) {
      mesh.vertices.emplace_back(0.0, one, ratio);
      mesh.vertices.emplace_back(one, ratio, 0.0);
      mesh.vertices.emplace_back(ratio, 0.0, one);
    }
  }
  // Faces are the triples of vertices at edge distance 2 from each other.
  const auto adjacent = [&mesh](std::uint32_t i, std::uint32_t j) {
    return (mesh.vertices[i] - mesh.vertices[j]).norm() < 2.1;
  };
  for (std::uint32_t i = 0; i < 12; ++i) {
    for (std::uint32_t j = i + 1; j < 12; ++j) {
      for (std::uint32_t k = j + 1; k < 12; ++k) {
        if (!adjacent(i, j) || !adjacent(j, k) || !adjacent(i, k)) continue;
        const core::Vec3 &a = mesh.vertices[i], &b = mesh.vertices[j], &c = mesh.vertices[k];
        const bool outward = a.dot(b.cross(c)) > 0.0;
        add_triangle(mesh, i, outward ? j : k, outward ? k : j, 0);
      }
    }
  }
  return mesh;
}

}  // namespace

TriMesh make_box(const core::Vec3& low, const core::Vec3& high) {
  if (!low.allFinite() || !high.allFinite() || !((high - low).array() > 0.0).all()) {
    reject_shape("a box needs three positive finite sides",
                 "the first corner must be below the second along x, y and z");
  }
  TriMesh mesh;
  mesh.groups = {"-x", "+x", "-y", "+y", "-z", "+z"};
  for (unsigned corner = 0; corner < 8; ++corner) {
    mesh.vertices.emplace_back(corner & 1U ? high.x() : low.x(), corner & 2U ? high.y() : low.y(),
                               corner & 4U ? high.z() : low.z());
  }
  constexpr std::uint32_t kSides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                          {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (std::uint32_t side = 0; side < 6; ++side) {
    const auto& corner = kSides[side];
    add_triangle(mesh, corner[0], corner[1], corner[2], side);
    add_triangle(mesh, corner[0], corner[2], corner[3], side);
  }
  return mesh;
}

TriMesh make_cylinder(double radius, double height, int segments, CylinderRadius kind) {
  if (!positive(radius) || !positive(height))
    reject_shape("a cylinder needs a positive radius and height", "");
  if (segments < 3) {
    reject_shape("a cylinder of " + std::to_string(segments) + " segments", "give at least 3 segments");
  }
  const double step = core::kTwoPi / segments;
  if (kind == CylinderRadius::equal_area) {
    radius *= std::sqrt(core::kPi / (0.5 * segments * std::sin(step)));  // polygon area n/2 R^2 sin(2 pi/n)
  }
  TriMesh mesh;
  mesh.groups = {"side", "-z", "+z"};
  const auto n = static_cast<std::uint32_t>(segments);
  for (const double z : {0.0, height}) {
    for (int i = 0; i < segments; ++i) {
      mesh.vertices.emplace_back(radius * std::cos(step * i), radius * std::sin(step * i), z);
    }
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t next = (i + 1) % n;
    add_triangle(mesh, i, next, n + next, 0);
    add_triangle(mesh, i, n + next, n + i, 0);
  }
  const std::size_t walls = mesh.triangles.size();
  // Every triangulation of a polygon by its corners alone has triangles of three neighbouring corners, which
  // lose their area as the corners become many: then a vertex in the middle, as narrow as the sides are.
  const double flattest = radius * (1.0 - std::cos(step));
  if (flattest >= kFlatCap * std::max(radius, height)) {
    for (std::uint32_t i = 1; i + 1 < n; ++i) add_triangle(mesh, 0, i + 1, i, 1);
    for (std::uint32_t i = 1; i + 1 < n; ++i) add_triangle(mesh, n, n + i, n + i + 1, 2);
  } else {
    mesh.vertices.emplace_back(0.0, 0.0, 0.0);
    mesh.vertices.emplace_back(0.0, 0.0, height);
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t next = (i + 1) % n;
      add_triangle(mesh, 2 * n, next, i, 1);
      add_triangle(mesh, 2 * n + 1, n + i, n + next, 2);
    }
  }
  if (kind == CylinderRadius::inscribed_polygon)
    mesh.set_support(SupportSurface::cylinder(core::Vec3::Zero(), core::Vec3::UnitZ(), radius), 0, walls);
  return mesh;
}

TriMesh make_cone(double bottom_radius, double top_radius, double height, int segments) {
  if (!positive(height) || !(bottom_radius >= 0.0) || !(top_radius >= 0.0) ||
      !positive(bottom_radius + top_radius))
    reject_shape("a cone needs a positive height, and two radii of which one at least is above 0", "");
  if (segments < 3)
    reject_shape("a cone of " + std::to_string(segments) + " segments", "give at least 3 segments");
  if (bottom_radius == top_radius) return make_cylinder(bottom_radius, height, segments);
  TriMesh mesh;
  mesh.groups = {"side"};
  const auto add_circle = [&](double radius, double z) {
    std::vector<std::uint32_t> circle;
    if (radius == 0.0) {
      circle.assign(static_cast<std::size_t>(segments), add_vertex(mesh, core::Vec3(0.0, 0.0, z)));
      return circle;
    }
    const double step = core::kTwoPi / segments;
    for (int i = 0; i < segments; ++i)
      circle.push_back(add_vertex(mesh, {radius * std::cos(step * i), radius * std::sin(step * i), z}));
    return circle;
  };
  const std::vector<std::uint32_t> low = add_circle(bottom_radius, 0.0),
                                   high = add_circle(top_radius, height);
  for (std::size_t i = 0; i < low.size(); ++i) {
    const std::size_t next = (i + 1) % low.size();
    if (bottom_radius > 0.0) add_triangle(mesh, low[i], low[next], high[next], 0);
    if (top_radius > 0.0) add_triangle(mesh, low[i], high[next], high[i], 0);
  }
  const core::Vec3 z = core::Vec3::UnitZ();
  mesh.set_support(bottom_radius > 0.0
                       ? SupportSurface::cone(core::Vec3::Zero(), z, bottom_radius, top_radius, height)
                       : SupportSurface::cone(height * z, -z, top_radius, bottom_radius, height),
                   0, mesh.triangles.size());
  const auto add_end = [&](const std::vector<std::uint32_t>& circle, bool up, const std::string& name) {
    const auto group = static_cast<std::uint32_t>(mesh.groups.size());
    mesh.groups.push_back(name);
    for (std::size_t i = 1; i + 1 < circle.size(); ++i)
      add_triangle(mesh, circle[0], circle[up ? i : i + 1], circle[up ? i + 1 : i], group);
  };
  if (bottom_radius > 0.0) add_end(low, false, "-z");
  if (top_radius > 0.0) add_end(high, true, "+z");
  mesh.support.resize(mesh.triangles.size(), kNoSupport);
  return mesh;
}

TriMesh make_sphere(double radius, int subdivisions) {
  if (!positive(radius)) reject_shape("a sphere needs a positive radius", "");
  if (subdivisions < 1) reject_shape("a sphere with fewer than 1 subdivision", "1 gives an icosahedron");
  TriMesh mesh = subdivide_faces(icosahedron(), subdivisions);
  for (core::Vec3& vertex : mesh.vertices) vertex *= radius / vertex.norm();
  mesh.set_support(SupportSurface::sphere(core::Vec3::Zero(), radius), 0, mesh.triangles.size());
  return mesh;
}

TriMesh subdivide_faces(const TriMesh& mesh, int n) {
  if (n < 1) reject_shape("triangles cannot be cut in fewer than 1", "");
  TriMesh fine;
  fine.vertices = mesh.vertices;
  fine.groups = mesh.groups;
  fine.group_tags = mesh.group_tags;
  const auto steps = static_cast<std::uint32_t>(n);
  // First new vertex of each cut edge, counted from its lower-numbered end.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> cut_edges;
  const auto edge_vertex = [&](std::uint32_t from, std::uint32_t to, std::uint32_t i) {
    if (i == 0) return from;
    if (i == steps) return to;
    const auto low = std::min(from, to), high = std::max(from, to);
    const auto [entry, is_new] =
        cut_edges.try_emplace({low, high}, static_cast<std::uint32_t>(fine.vertices.size()));
    if (is_new) {
      for (std::uint32_t k = 1; k < steps; ++k) {
        const double t = static_cast<double>(k) / steps;
        add_vertex(fine, (1.0 - t) * mesh.vertices[low] + t * mesh.vertices[high]);
      }
    }
    return entry->second + (from == low ? i : steps - i) - 1;
  };

  std::vector<std::vector<std::uint32_t>> rows(steps + 1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    for (std::uint32_t row = 0; row <= steps; ++row) {  // rows run parallel to ab, the last is c
      rows[row].clear();
      for (std::uint32_t i = 0; i + row <= steps; ++i) {
        if (row == 0) {
          rows[row].push_back(edge_vertex(a, b, i));
        } else if (i == 0) {
          rows[row].push_back(edge_vertex(a, c, row));
        } else if (i + row == steps) {
          rows[row].push_back(edge_vertex(b, c, row));
        } else {
          const double u = static_cast<double>(i) / steps, v = static_cast<double>(row) / steps;
          rows[row].push_back(add_vertex(
              fine, (1.0 - u - v) * mesh.vertices[a] + u * mesh.vertices[b] + v * mesh.vertices[c]));
        }
      }
    }
    const std::uint32_t group = mesh.group.empty() ? 0 : mesh.group[t];
    for (std::uint32_t row = 0; row < steps; ++row) {
      for (std::size_t i = 0; i + 1 < rows[row].size(); ++i) {
        add_triangle(fine, rows[row][i], rows[row][i + 1], rows[row + 1][i], group);
        if (i + 1 < rows[row + 1].size()) {
          add_triangle(fine, rows[row][i + 1], rows[row + 1][i + 1], rows[row + 1][i], group);
        }
      }
    }
  }
  if (mesh.group.empty()) fine.group.clear();
  return fine;
}

void reverse_orientation(TriMesh& mesh) {
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
}

TriMesh transformed(const TriMesh& mesh, const Eigen::Affine3d& transform) {
  const double determinant = transform.linear().determinant();
  if (!transform.matrix().allFinite() || determinant == 0.0) {
    reject_shape("a transform that flattens the mesh or is not finite", "give scales that are not zero");
  }
  TriMesh moved = mesh;
  for (core::Vec3& vertex : moved.vertices) vertex = transform * vertex;
  if (determinant < 0.0) reverse_orientation(moved);
  for (SupportSurface& surface : moved.supports) {
    const std::optional<SupportSurface> in_place = surface.moved(transform);
    if (in_place) {
      surface = *in_place;
      continue;
    }
    moved.supports.clear();
    moved.support.clear();
    break;
  }
  return moved;
}

TriMesh joined(const TriMesh& a, const TriMesh& b) {
  TriMesh both = a;
  const auto offset = static_cast<std::uint32_t>(a.vertices.size());
  both.vertices.insert(both.vertices.end(), b.vertices.begin(), b.vertices.end());
  std::vector<std::uint32_t> group_of_b;
  for (std::size_t g = 0; g < b.groups.size(); ++g)
    group_of_b.push_back(both.group_index(b.groups[g], b.tags_of(g)));
  for (const auto& [i, j, k] : b.triangles) both.triangles.push_back({i + offset, j + offset, k + offset});
  for (const std::uint32_t group : b.group) both.group.push_back(group_of_b[group]);
  if (a.supports.empty() && b.supports.empty()) return both;
  both.support.resize(a.triangles.size(), kNoSupport);
  const auto first = static_cast<std::uint32_t>(a.supports.size());
  for (std::size_t t = 0; t < b.triangles.size(); ++t)
    both.support.push_back(b.support_of(t) == kNoSupport ? kNoSupport : first + b.support_of(t));
  both.supports.insert(both.supports.end(), b.supports.begin(), b.supports.end());
  return both;
}

}  // namespace scintray::mesh
