#include "scintray/contact/detail/geometry.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>

#include "scintray/core/error.hpp"
#include "scintray/mesh/triangle_distance.hpp"

namespace scintray::contact {

namespace {

/// The Fibonacci lattice (González 2010, Math. Geosci. 42, 49, eq. 1): directions nearly uniform on the
/// sphere and in general position, so a ray along one rarely hits an edge, and then another one is tried.
core::Vec3 lattice_direction(int i) {
  constexpr int kCount = 101;
  constexpr double kGoldenAngle = core::kTwoPi * (1.0 - 1.0 / std::numbers::phi);
  const double z = 1.0 - (2.0 * i + 1.0) / kCount;
  const double r = std::sqrt(1.0 - z * z);
  const double phi = kGoldenAngle * i + 0.1;
  return {r * std::cos(phi), r * std::sin(phi), z};
}

struct Hit {
  double t;       ///< along the ray
  double margin;  ///< least barycentric coordinate: negative outside, near zero at an edge
};

/// Intersection of the line with the plane of the triangle (Möller and Trumbore 1997); none when parallel.
std::optional<Hit> intersect(const core::Vec3& origin, const core::Vec3& direction, const core::Vec3& a,
                             const core::Vec3& b, const core::Vec3& c) {
  const core::Vec3 e1 = b - a, e2 = c - a;
  const core::Vec3 p = direction.cross(e2);
  const double determinant = e1.dot(p);
  if (std::abs(determinant) <= 1e-14 * e1.norm() * e2.norm()) return std::nullopt;
  const core::Vec3 s = origin - a;
  const core::Vec3 q = s.cross(e1);
  const double u = s.dot(p) / determinant, v = direction.dot(q) / determinant;
  return Hit{e2.dot(q) / determinant, std::min({u, v, 1.0 - u - v})};
}

}  // namespace

Eigen::Matrix3d natural_axes(const std::vector<PlacedPart>& parts) {
  const auto largest = [&](auto&& measure) {
    core::Vec3 best = core::Vec3::Zero();
    double best_area = 0.0;
    for (const PlacedPart& part : parts)
      for (const Triangle& t : part.triangles) {
        const core::Vec3& a = part.vertices[t[0]];
        const core::Vec3 v = measure((part.vertices[t[1]] - a).cross(part.vertices[t[2]] - a));
        if (v.norm() > best_area * (1.0 + 1e-9)) {
          best_area = v.norm();
          best = v.normalized();
        }
      }
    return best;
  };
  const core::Vec3 first = largest([](const core::Vec3& v) -> core::Vec3 { return v; });
  const core::Vec3 second =
      largest([&](const core::Vec3& v) -> core::Vec3 { return v - v.dot(first) * first; });
  if (first.isZero() || second.isZero()) return Eigen::Matrix3d::Identity();
  Eigen::Matrix3d axes;
  axes << first.transpose(), second.transpose(), first.cross(second).transpose();
  const bool upright = (axes.cwiseAbs().rowwise().maxCoeff().array() > 1.0 - 1e-12).all();
  return upright ? Eigen::Matrix3d::Identity() : axes;
}

Body::Body(const PlacedPart& part, const Eigen::Matrix3d& axes)
    : face(part.face), support(part.support), axes_(axes) {
  std::map<std::array<double, 3>, std::uint32_t> known;
  std::vector<std::uint32_t> index;
  index.reserve(part.vertices.size());
  for (const core::Vec3& v : part.vertices) {
    const auto [it, is_new] =
        known.try_emplace({v.x(), v.y(), v.z()}, static_cast<std::uint32_t>(vertices.size()));
    if (is_new) vertices.push_back(v);
    index.push_back(it->second);
  }
  triangles.reserve(part.triangles.size());
  for (const Triangle& t : part.triangles) triangles.push_back({index[t[0]], index[t[1]], index[t[2]]});
  find_shells();
  update();
}

void Body::find_shells() {
  std::vector<std::uint32_t> root(vertices.size());
  std::iota(root.begin(), root.end(), 0U);
  const auto find = [&](std::uint32_t v) {
    while (root[v] != v) v = root[v] = root[root[v]];
    return v;
  };
  std::vector<bool> used(vertices.size(), false);
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k) {
      const std::pair<std::uint32_t, std::uint32_t> ends = std::minmax(find(t[k]), find(t[(k + 1) % 3]));
      root[ends.second] = ends.first;
      used[t[k]] = true;
    }
  for (std::uint32_t v = 0; v < vertices.size(); ++v)
    if (used[v] && root[v] == v) shells.push_back(v);
}

void Body::update() {
  const std::size_t count = triangles.size();
  normal.resize(count);
  std::vector<Box> boxes(count);
  area = 0.0;
  box = Box();
  // About a point of the body, so that volumes far from the origin keep their digits.
  const core::Vec3 origin = vertices.empty() ? core::Vec3(core::Vec3::Zero()) : vertices[0];
  double six_volumes = 0.0;
  for (std::uint32_t t = 0; t < count; ++t) {
    const core::Vec3 v = area_vector(t);
    const double size = v.norm();
    normal[t] = size > 0.0 ? core::Vec3(v / size) : core::Vec3(core::Vec3::Zero());
    area += size;
    six_volumes += 2.0 * v.dot(corner(t, 0) - origin);
    boxes[t] = box_of(t);
    box.add(boxes[t]);
  }
  volume = six_volumes / 6.0;
  tree = BoxTree(std::move(boxes));
}

Box Body::box_of(std::uint32_t triangle) const {
  Box result;
  for (int k = 0; k < 3; ++k) result.add(axes_ * corner(triangle, k));
  return result;
}

Box Body::box_of(const core::Vec3& a, const core::Vec3& b) const {
  Box result;
  result.add(axes_ * a);
  result.add(axes_ * b);
  return result;
}

core::Vec3 Body::area_vector(std::uint32_t triangle) const {
  const core::Vec3& a = corner(triangle, 0);
  return 0.5 * (corner(triangle, 1) - a).cross(corner(triangle, 2) - a);
}

Side Body::side_of(const core::Vec3& point, double margin_mm) const {
  const Box near = box_of(point, point).grown(margin_mm);
  if (!near.overlaps(box)) return Side::outside;
  for (const std::uint32_t t : tree.touching(near))
    if (mesh::distance_to_triangle(point, corner(t, 0), corner(t, 1), corner(t, 2)) <= margin_mm)
      return Side::on_surface;
  return encloses(point) ? Side::inside : Side::outside;
}

bool Body::encloses(const core::Vec3& point) const {
  constexpr double kEdge = 1e-9;  // closer to an edge than this the count of crossings is not certain
  constexpr int kTries = 101;
  for (int attempt = 0; attempt < kTries; ++attempt) {
    const core::Vec3 direction = lattice_direction((attempt * 37 + 11) % kTries);
    int crossings = 0;
    bool certain = true;
    for (const std::uint32_t t : tree.on_ray(axes_ * point, axes_ * direction)) {
      if (normal[t].isZero()) continue;
      const auto hit = intersect(point, direction, corner(t, 0), corner(t, 1), corner(t, 2));
      if (!hit || (std::abs(hit->margin) <= kEdge && hit->t > 0.0)) {
        certain = false;
        break;
      }
      if (hit->margin > 0.0 && hit->t > 0.0) {
        crossings += direction.dot(normal[t]) > 0.0 ? 1 : -1;
      }
    }
    if (certain) return crossings > 0;
  }
  throw core::InternalError("no ray from a point is free of the edges of a part");
}

core::Vec3 Body::interior_point() const {
  constexpr std::size_t kStarts = 8;
  std::vector<std::uint32_t> order(triangles.size());
  std::iota(order.begin(), order.end(), 0U);
  const std::size_t starts = std::min(kStarts, order.size());
  std::vector<double> size(order.size());
  for (std::uint32_t t = 0; t < size.size(); ++t) size[t] = area_vector(t).norm();
  std::partial_sort(
      order.begin(), order.begin() + static_cast<std::ptrdiff_t>(starts), order.end(),
      [&](std::uint32_t a, std::uint32_t b) { return std::pair(-size[a], a) < std::pair(-size[b], b); });
  double longest = 0.0;
  core::Vec3 best = vertices[0];
  for (std::size_t i = 0; i < starts; ++i) {
    const std::uint32_t start = order[i];
    // Off the centroid, so that the chord does not end on an edge of a symmetric mesh.
    const core::Vec3 from = 0.36 * corner(start, 0) + 0.33 * corner(start, 1) + 0.31 * corner(start, 2);
    const core::Vec3 inward = -normal[start];
    double length = std::numeric_limits<double>::infinity();
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      if (t == start) continue;
      const auto hit = intersect(from, inward, corner(t, 0), corner(t, 1), corner(t, 2));
      if (hit && hit->margin >= -1e-9 && hit->t > 0.0) length = std::min(length, hit->t);
    }
    if (std::isfinite(length) && length > longest) {
      longest = length;
      best = from + 0.5 * length * inward;
    }
  }
  return best;
}

}  // namespace scintray::contact
